// A looped replay: every round begins with an empty window and ends in the same layers.
#include <catch2/catch.hpp>

#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "ipc/layers.hpp"
#include "tests/ipc/processes.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::ipc;
using namespace gvom::ipc::test;
using namespace gvom::test;

namespace {

/// What layers say, but for the times at which they were made.
struct Content {
  std::int64_t stamp_ns = 0;
  std::uint32_t maps_in_window = 0;
  std::vector<std::int32_t> origin;
  std::vector<std::byte> arrays;

  bool operator==(const Content& other) const {
    return stamp_ns == other.stamp_ns && maps_in_window == other.maps_in_window && origin == other.origin &&
           arrays == other.arrays;
  }
};

Content content_of(const LayersSample& sample) {
  const Layers& header = sample.header();
  Content content{header.header.stamp_ns,
                  header.maps_in_window,
                  {header.grid.origin.begin(), header.grid.origin.end()},
                  {}};
  const auto append = [&content](const auto& span) {
    const auto* bytes = reinterpret_cast<const std::byte*>(span.data());
    content.arrays.insert(content.arrays.end(), bytes, bytes + span.size() * sizeof(*span.data()));
  };
  for (int i = 0; i < kLayers; ++i) {
    append(sample.layer_f(static_cast<LayerId>(i)));
    append(sample.layer_u8(static_cast<LayerId>(i)));
  }
  return content;
}

constexpr std::int64_t kPeriod_ns = 100'000'000;
constexpr int kMapsInRound = 10;
constexpr std::uint32_t kMapsInWindow = 4;

/// Of a round that has come to its end.
struct Round {
  Content first, last;

  /// It began with an empty window, and fusion and this reader had the processor at its begin and at its end.
  [[nodiscard]] bool is_whole() const {
    const std::int64_t begin_ns = first.stamp_ns - (first.maps_in_window - 1) * kPeriod_ns;
    return first.maps_in_window < kMapsInWindow && last.maps_in_window == kMapsInWindow &&
           last.stamp_ns == begin_ns + (kMapsInRound - 1) * kPeriod_ns;
  }
};

/// Ends well if two of the first twenty rounds are whole and end in the same layers.
void watch_rounds(Step& begin_reached) {
  auto runtime = Runtime::connect("watcher", kPatience).value();
  auto layers = LayersSubscriber::open(runtime).value();
  begin_reached.reach(1);
  std::optional<Round> round;
  std::uint64_t epoch = 0;
  std::vector<Content> ends;
  for (int rounds = 0; ends.size() < 2;) {
    const auto sample = take_within(layers);
    EXPECT(sample);
    Content content = content_of(*sample);
    if (round && sample->header().header.epoch == epoch) {
      round->last = std::move(content);
      continue;
    }
    EXPECT(!round || sample->header().header.epoch > epoch);
    EXPECT(rounds++ < 20);
    if (round && round->is_whole()) ends.push_back(std::move(round->last));
    epoch = sample->header().header.epoch;
    round = Round{content, content};
  }
  EXPECT(ends[0] == ends[1]);
  EXPECT(!(ends[0] == round->first));
}

}  // namespace

TEST_CASE("each round of a looped replay begins with an empty window and ends in the same layers") {
  const TemporaryFolder folder;
  simulated(folder.path(), 1);
  Graph graph(front_only(folder.path()));
  Step up;
  Child watcher([&] { watch_rounds(up); });
  REQUIRE(up.wait_for(1));
  graph.start_readers();
  const auto odometry = graph.replay({"--rate", "1", "--loop"});
  CHECK(watcher.wait() == 0);
  CHECK(odometry->stop() == 0);
  graph.stop();
  CHECK(graph.ingest("front").output().find("begins anew") != std::string::npos);
  CHECK(graph.fusion().output().find("the window is emptied") != std::string::npos);
}
