#include "tests/core/race.hpp"

#include <malloc.h>

#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <utility>

#include "core/brick_map_storage.hpp"
#include "core/mapper.hpp"
#include "core/open_backend.hpp"
#include "tests/core/compare.hpp"

namespace gvom::test {

namespace {

constexpr std::size_t kMostReturns = 1000;

struct Tally {
  int added = 0, refused = 0, unbracketed = 0;
  unsigned flags = 0;  // seen in any column
};

class Race {
 public:
  Race(Backend backend, const Scenario& scenario)
      : scenario_(scenario),
        odometry_(scenario.odometry.size()),
        fuser_(
            std::move(open_fusion(backend, {scenario.config, int(scenario.lidars.size()), kMostReturns, {}})
                          .value()
                          .backend)),
        expected_(scenario.config.window, scenario.config.memory) {
    for (const StampedPose& pose : scenario.odometry) odometry_.add(pose);
    const MapperConfig& config = scenario.config;
    for (const LidarGeometry& lidar : scenario.lidars) {
      const VoxelizerSetup setup{config.map, lidar, config.vehicle, kMostReturns, {}};
      mappers_.push_back(std::make_unique<SweepMapper>(
          config.map, std::move(open_voxelizer(backend, setup).value().backend)));
    }
  }

  /// @param reset_after arrivals after which everything is forgotten, as when a log starts again
  Tally run(std::size_t reset_after) {
    for (const Arrival& arrival : scenario_.arrivals) {
      if (reset_after-- == 0) reset();
      CAPTURE(arrival.lidar, arrival.sweep.stamp_ns);
      take(arrival);
    }
    return tally_;
  }

 private:
  void reset() {
    fuser_.reset();
    for (const WindowMap& left : fuser_.window().left()) kept_.erase(left.token);
    REQUIRE(kept_.empty());
    expected_ = oracle::Fusion(scenario_.config.window, scenario_.config.memory);
  }

  void take(const Arrival& arrival) {
    SweepMapper& mapper = *mappers_[std::size_t(arrival.lidar)];
    if (tally_.added % 5 == 4)  // counted and not written: forgotten
      mapper.count(scenario_.arrivals.front().sweep, odometry_);
    const auto shape = mapper.count(arrival.sweep, odometry_);
    auto expected = oracle::map_sweep(scenario_.config, scenario_.lidars[std::size_t(arrival.lidar)],
                                      arrival.sweep, scenario_.odometry);
    REQUIRE(shape.has_value() == expected.has_value());
    if (!shape) {
      ++tally_.unbracketed;
      return;
    }
    auto storage = std::make_unique<BrickMapStorage>();
    REQUIRE(mapper.write(storage->resize(*shape)));
    const BrickMapView view = storage->view(mapper.grid(), arrival.sweep.stamp_ns, mapper.T_odom_base());
    REQUIRE(difference(view, *expected) == "");
    check_filter(mapper.filter_counts(), expected->filter);
    expected->lidar = arrival.lidar;
    fuse({view, arrival.lidar, next_token_}, std::move(storage), *expected);
  }

  static void check_filter(const FilterCounts& counts, const FilterCounts& expected) {
    REQUIRE(counts.used == expected.used);
    REQUIRE(counts.not_finite == expected.not_finite);
    REQUIRE(counts.too_near == expected.too_near);
    REQUIRE(counts.too_far == expected.too_far);
    REQUIRE(counts.body == expected.body);
  }

  void fuse(const WindowMap& map, std::unique_ptr<BrickMapStorage> storage,
            const oracle::BufferMap& expected) {
    const bool added = fuser_.add(map).value() == AddResult::added;
    REQUIRE(added == expected_.add(expected));
    ++(added ? tally_.added : tally_.refused);
    if (added) {
      kept_[next_token_++] = std::move(storage);
      for (const WindowMap& left : fuser_.window().left()) REQUIRE(kept_.erase(left.token) == 1);
    }
    REQUIRE(kept_.size() == expected_.window().size());
    if (const cpu::FusedMap* fused = cpu_map(fuser_))
      REQUIRE(difference(fused->view(), expected_, scenario_.config.layers.min_hits) == "");
    REQUIRE(export_difference(fuser_, expected_) == "");
    oracle::Layers layers(scenario_.config.map.size_xy);
    REQUIRE(fuser_.make_layers(layers.arrays()));
    REQUIRE(difference(layers, oracle::make_layers(scenario_.config, expected_)) == "");
    for (const std::uint8_t flags : layers.flags) tally_.flags |= flags;
  }

  const Scenario& scenario_;
  OdometryBuffer odometry_;
  std::vector<std::unique_ptr<SweepMapper>> mappers_;
  MapFuser fuser_;
  oracle::Fusion expected_;
  std::map<std::uint64_t, std::unique_ptr<BrickMapStorage>> kept_;  // by token; freed once its map has left
  std::uint64_t next_token_ = 0;
  Tally tally_;
};

/// The oracle's dense arrays are made anew for each map. Handed back to the kernel each time, and zeroed by
/// it page by page, they took most of the time.
void keep_freed_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

}  // namespace

unsigned race(Backend backend, const ScenarioSize& size, std::uint64_t first_seed, std::uint64_t seeds) {
  keep_freed_memory();
  Tally total;
  for (std::uint64_t seed = first_seed; seed < first_seed + seeds; ++seed) {
    CAPTURE(seed, size.size_xy, size.size_z, size.on_faces);
    const Scenario scenario = random_scenario(seed, size);
    const Tally tally =
        Race(backend, scenario).run(seed % 3 == 0 ? scenario.arrivals.size() / 2 : scenario.arrivals.size());
    total.added += tally.added;
    total.refused += tally.refused;
    total.unbracketed += tally.unbracketed;
    total.flags |= tally.flags;
  }
  CHECK(total.added > 8 * static_cast<int>(seeds));
  CHECK(total.refused > 0);
  CHECK(total.unbracketed > 0);
  return total.flags;
}

}  // namespace gvom::test
