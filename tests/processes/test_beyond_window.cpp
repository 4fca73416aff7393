// What is remembered beyond the window (R17) when the process dies that saw it, or that remembers it.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <numeric>
#include <string>
#include <vector>

#include "core/format/layers.hpp"
#include "tests/processes/layers_log.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/processes/results.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;

namespace {

using Columns = std::vector<std::size_t>;

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kPeriod_ns = kSecond_ns / 10;  // of a lidar
constexpr std::int64_t kBeat_ns = std::int64_t{1} << 29;
constexpr std::int64_t kWindow_ns = kSecond_ns / 2;
constexpr std::int64_t kBeatsRemembered = 2;  // of memory.max_age_s 1
constexpr std::int64_t kMissingAfter_ns = kSecond_ns * 3 / 10;
constexpr std::int64_t kRounding_ns = 1000;  // of last_seen, a float
constexpr int kBufferSize = 4;               // of small_map()
constexpr std::uint8_t kUnknownCost = 255;

std::int64_t beat_of(std::int64_t stamp_ns) {
  return stamp_ns / kBeat_ns;
}

bool shows(std::uint8_t visibility, Visibility what) {
  return visibility == static_cast<std::uint8_t>(what);
}

/// No ground, though rays may have passed above it.
bool is_unknown(std::uint8_t visibility) {
  return shows(visibility, Visibility::unobserved) || shows(visibility, Visibility::free_only);
}

template <typename Holds>
bool all_of(const Columns& columns, Holds holds) {
  return std::all_of(columns.begin(), columns.end(), holds);
}

/// The vehicle with a window so short that a dead lidar's maps leave it soon, and so much memory.
Vehicle with_memory(Vehicle vehicle, const std::string& memory_s) {
  vehicle.sets.insert(vehicle.sets.end(),
                      {"window.max_age_s=0.5", "memory.max_age_s=" + memory_s, kRoomForLayersLog});
  return vehicle;
}

/// The ground that each lidar alone sees, in each single sweep of the drive, and that the other neither sees
/// nor remembers: by gvom-map, which has no processes.
struct Sides {
  explicit Sides(const Vehicle& vehicle)
      : front_maps(map_without(vehicle, "rear")), rear_maps(map_without(vehicle, "front")) {
    origin = origin_of(last_map(front_maps));
    front = seen_by_first(front_maps, rear_maps);
    rear = seen_by_first(rear_maps, front_maps);
  }

  static std::string map_without(Vehicle vehicle, const std::string& blind) {
    const std::string range = "lidars." + blind;
    vehicle.sets.insert(vehicle.sets.end(),
                        {"window.buffer_size=1", range + ".max_range_m=1000", range + ".min_range_m=999"});
    return map_offline(vehicle, "without_" + blind);
  }

  static Columns seen_by_first(const std::string& first, const std::string& second) {
    Columns columns(LoggedLayers::kColumns);
    std::iota(columns.begin(), columns.end(), std::size_t{0});
    for (int map = 2; map < map_count(first); ++map) {
      const auto seen = visibility_of(map_of(first, map));
      const auto unseen = visibility_of(map_of(second, map));
      const auto other = [&](std::size_t i) {
        return !shows(seen[i], Visibility::ground_seen) || !is_unknown(unseen[i]);
      };
      columns.erase(std::remove_if(columns.begin(), columns.end(), other), columns.end());
    }
    return columns;
  }

  /// Those where the drive begins: open ground, without leaves that rays of the other lidar pass through.
  [[nodiscard]] Columns near(const Columns& columns) const {
    const auto is_near = [this](std::size_t i) {
      const int x = static_cast<int>(i % LoggedLayers::kSize) + origin[0];
      const int y = static_cast<int>(i / LoggedLayers::kSize) + origin[1];
      return std::abs(x) <= kNear && std::abs(y) <= kNear;
    };
    Columns found;
    std::copy_if(columns.begin(), columns.end(), std::back_inserter(found), is_near);
    return found;
  }

  static constexpr int kNear = 20;  // columns
  std::string front_maps, rear_maps;
  std::vector<std::int32_t> origin;
  Columns front, rear;
};

/// Layers after layers, what they show of the side of a lidar that died.
class DeadSide {
 public:
  DeadSide(std::string lidar, Columns columns) : lidar_(std::move(lidar)), columns_(std::move(columns)) {}

  void check(const LoggedLayers& layers) {
    const ipc::LidarStatus& lidar = layers.lidar(lidar_.c_str());
    const std::int64_t age_ns = layers.header.header.stamp_ns - lidar.newest_stamp_ns;
    INFO("the newest map of the lidar is " << age_ns << " ns old");
    CHECK((lidar.missing == 1) == (age_ns > kMissingAfter_ns));
    CHECK((lidar.maps_in_window == 0) == (age_ns > kWindow_ns));
    if (age_ns <= 2 * kPeriod_ns) check_seen(layers);
    if (age_ns <= kWindow_ns) return check_known(layers);
    const std::int64_t beat = beat_of(lidar.newest_stamp_ns);
    if (beat_of(layers.header.header.stamp_ns) - beat <= kBeatsRemembered)
      check_remembered(layers, beat * kBeat_ns);
    else
      check_forgotten(layers);
  }

  /// That there were layers of each time.
  void check_complete() const {
    CHECK(seen_ >= 5);
    CHECK(remembered_ >= 1);
    CHECK(forgotten_ >= 1);
  }

 private:
  void check_seen(const LoggedLayers& layers) {
    ++seen_;
    CHECK(all_of(columns_,
                 [&](std::size_t i) { return shows(layers.visibility[i], Visibility::ground_seen); }));
  }

  /// Maps leave the window one by one: what it has lost is remembered already.
  void check_known(const LoggedLayers& layers) const {
    CHECK(all_of(columns_, [&](std::size_t i) {
      return shows(layers.visibility[i], Visibility::ground_seen) || is_remembered(layers.visibility[i]);
    }));
  }

  /// Seen in the beat of the lidar's newest map; a few columns, whose lowest voxel that map did not hit,
  /// before.
  void check_remembered(const LoggedLayers& layers, std::int64_t beat_ns) {
    ++remembered_;
    CHECK(all_of(columns_, [&](std::size_t i) { return is_remembered(layers.visibility[i]); }));
    CHECK(all_of(columns_, [&](std::size_t i) { return layers.seen_ns(i) <= beat_ns + kRounding_ns; }));
    const auto seen_last = std::count_if(columns_.begin(), columns_.end(), [&](std::size_t i) {
      return layers.seen_ns(i) >= beat_ns - kRounding_ns;
    });
    CHECK(seen_last * 10 >= static_cast<std::ptrdiff_t>(columns_.size()) * 9);
  }

  void check_forgotten(const LoggedLayers& layers) {
    ++forgotten_;
    CHECK(all_of(columns_, [&](std::size_t i) {
      return is_unknown(layers.visibility[i]) && layers.cost[i] == kUnknownCost;
    }));
  }

  std::string lidar_;
  Columns columns_;
  int seen_ = 0, remembered_ = 0, forgotten_ = 0;
};

/// True if the lidar's newest map is no older than it is where nothing is late.
bool check_living_side(const LoggedLayers& layers, const char* name, const Columns& columns) {
  const ipc::LidarStatus& lidar = layers.lidar(name);
  const std::int64_t age_ns = layers.header.header.stamp_ns - lidar.newest_stamp_ns;
  CHECK((lidar.missing == 1) == (age_ns > kMissingAfter_ns));
  if (age_ns > 2 * kPeriod_ns) return false;
  const std::int64_t oldest_ns = layers.header.header.stamp_ns - kWindow_ns - kRounding_ns;
  CHECK(all_of(columns, [&](std::size_t i) {
    return shows(layers.visibility[i], Visibility::ground_seen) && layers.seen_ns(i) >= oldest_ns;
  }));
  return true;
}

/// The begin of the beat of the first map that was fused: nothing is older in what one fusion remembers.
std::int64_t first_beat_ns(const LoggedLayers& first_layers) {
  std::int64_t first_ns = first_layers.header.header.stamp_ns;
  for (std::uint32_t i = 0; i < first_layers.header.lidar_count; ++i) {
    const ipc::LidarStatus& lidar = first_layers.header.lidars[i];
    if (lidar.maps_in_window > 0)
      first_ns = std::min(first_ns, lidar.newest_stamp_ns - (lidar.maps_in_window - 1) * kPeriod_ns);
  }
  return beat_of(first_ns) * kBeat_ns;
}

/// When the oldest of what is remembered was seen; the stamp if nothing is.
std::int64_t oldest_remembered_ns(const LoggedLayers& layers) {
  std::int64_t oldest_ns = layers.header.header.stamp_ns;
  for (std::size_t i = 0; i < LoggedLayers::kColumns; ++i)
    if (is_remembered(layers.visibility[i])) oldest_ns = std::min(oldest_ns, layers.seen_ns(i));
  return oldest_ns;
}

/// Whether it shows much ground that is remembered, not just rays.
bool remembers_ground(const LoggedLayers& layers) {
  int found = 0;
  for (std::size_t i = 0; i < LoggedLayers::kColumns; ++i)
    if (is_remembered(layers.visibility[i]) && layers.cost[i] != kUnknownCost) ++found;
  return found >= 100;
}

/// The index of the first layers of a fusion that was started again.
std::size_t first_of_second_fusion(const LayersLog& log) {
  for (std::size_t i = 1; i < log.size(); ++i)
    if (log[i].header.header.sequence <= log[i - 1].header.header.sequence) return i;
  return log.size();
}

}  // namespace

TEST_CASE("the side of a lidar that died is remembered as it was, then unknown; the other side stays seen") {
  const TemporaryFolder folder;
  const Vehicle vehicle = with_memory(simulated(folder.path(), 3.7, kCrawling_mps), "1");
  const Sides sides(vehicle);
  const Columns front = sides.near(sides.front);
  REQUIRE(front.size() >= 20);
  REQUIRE(sides.rear.size() >= 20);
  Graph graph(vehicle);
  const LayersLog log;
  REQUIRE(log.is_up());
  graph.start_readers();
  const auto odometry = graph.replay({"--rate", "0.5"});
  const auto has_full_window = [](const LoggedLayers& layers) {
    return layers.header.maps_in_window == 2 * kBufferSize;
  };
  REQUIRE(log.gets([&](const LoggedLayers& layers) {
    return has_full_window(layers) &&
           layers.header.header.stamp_ns >= log[0].header.header.stamp_ns + 7 * kPeriod_ns;
  }));
  graph.lose_ingest("front");
  CHECK(odometry->wait() == 0);
  graph.stop();

  DeadSide dead("front", front);
  bool full = false;
  int living = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    full = full || has_full_window(log[i]);
    if (!full) continue;
    INFO("layers " << i << " of " << log.size());
    REQUIRE(std::equal(sides.origin.begin(), sides.origin.end(), log[i].header.grid.origin.begin()));
    dead.check(log[i]);
    if (check_living_side(log[i], "rear", sides.rear)) ++living;
  }
  CHECK(living >= 5);
  dead.check_complete();
}

TEST_CASE("a fusion that is started again remembers nothing of what the one before it had fused") {
  const TemporaryFolder folder;
  Graph graph(with_memory(simulated(folder.path(), 5), "5"));
  const LayersLog log;
  REQUIRE(log.is_up());
  graph.start_readers();
  const auto odometry = graph.replay({"--rate", "0.5"});
  REQUIRE(log.gets([](const LoggedLayers& layers) {
    return remembers_ground(layers) &&
           oldest_remembered_ns(layers) < layers.header.header.stamp_ns - kSecond_ns;
  }));
  CHECK(graph.fusion().kill_asleep() == 128 + SIGKILL);
  graph.start_fusion();
  CHECK(odometry->wait() == 0);
  graph.stop();

  const std::size_t second = first_of_second_fusion(log);
  REQUIRE(second < log.size());
  const std::int64_t begin_ns = first_beat_ns(log[second]);
  REQUIRE(begin_ns <
          log[second - 1].header.header.stamp_ns + 2 * kSecond_ns);  // the first one's memory is 5 s
  for (std::size_t i = second; i < log.size(); ++i) {
    INFO("layers " << i << ", the second fusion's first are " << second);
    CHECK(oldest_remembered_ns(log[i]) >= begin_ns - kRounding_ns);
  }
  CHECK(remembers_ground(log.newest()));
}
