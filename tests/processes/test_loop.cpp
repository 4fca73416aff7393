// A looped replay: every round begins with an empty window and ends in the same layers.
#include <catch2/catch.hpp>

#include <cstring>

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

/// Takes layers until the third round begins; ends well if the first two began and ended as they must.
void watch_two_rounds(const Step& begin_reached) {
  auto runtime = Runtime::connect("watcher", kPatience).value();
  auto layers = LayersSubscriber::open(runtime).value();
  const_cast<Step&>(begin_reached).reach(1);
  std::vector<std::uint64_t> epochs;
  std::vector<Content> newest;
  while (epochs.size() < 3) {
    const auto sample = take_within(layers);
    EXPECT(sample);
    const std::uint64_t epoch = sample->header().header.epoch;
    Content content = content_of(*sample);
    if (epochs.empty() || epoch != epochs.back()) {
      EXPECT(epochs.empty() || epoch > epochs.back());
      EXPECT(content.maps_in_window < 4);  // one, or those that came while fusion had no processor
      epochs.push_back(epoch);
      newest.emplace_back();
    }
    newest.back() = std::move(content);
  }
  EXPECT(newest[0].maps_in_window == 4);
  EXPECT(newest[0].stamp_ns == newest[1].stamp_ns);
  EXPECT(newest[0] == newest[1]);
  EXPECT(!(newest[0] == newest[2]));
}

}  // namespace

TEST_CASE("each round of a looped replay begins with an empty window and ends in the same layers") {
  const TemporaryFolder folder;
  simulated(folder.path(), 1);
  Graph graph(front_only(folder.path()));
  Step up;
  Child watcher([&] { watch_two_rounds(up); });
  REQUIRE(up.wait_for(1));
  graph.start_readers();
  const auto odometry = graph.replay({"--rate", "1", "--loop"});
  CHECK(watcher.wait() == 0);
  CHECK(odometry->stop() == 0);
  graph.stop();
  CHECK(graph.ingest("front").output().find("begins anew") != std::string::npos);
  CHECK(graph.fusion().output().find("the window is emptied") != std::string::npos);
}
