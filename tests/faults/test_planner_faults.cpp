// Planners that hang or die: neither fusion nor another planner notices.
#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <new>
#include <random>

#include "ipc/planner.hpp"
#include "tests/faults/lab.hpp"

using namespace gvom::test;
using gvom::ipc::PlannerClient;
using gvom::ipc::test::Child;
using gvom::ipc::test::eventually;
using gvom::ipc::test::Step;
using namespace std::chrono_literals;

namespace {

constexpr int kCrashers = 10;
constexpr std::uint32_t kStrayChunks = 2;  // in flight

/// What a planner tells of the layers that fusion published.
struct Told {
  std::atomic<std::uint64_t> received{0};
  std::atomic<std::uint64_t> lost{0};
};

Told* shared_told() {
  void* memory = ::mmap(nullptr, sizeof(Told), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  return new (memory) Told;
}

/// Takes layers for ever, two at a time.
[[noreturn]] void live_as_planner(const std::string& name) {
  auto client = PlannerClient::connect(name).value();
  std::optional<gvom::ipc::LayersSample> held;
  while (true) {
    if (auto layers = client.newest_layers(1s)) held = std::move(*layers);
  }
}

/// Takes all layers. Its queue holds those of seconds: what is lost then was lost by fusion or by the bus,
/// not because this process got no processor.
[[noreturn]] void live_as_witness(Told& told) {
  constexpr std::uint32_t kQueue = 64;
  auto runtime = gvom::ipc::Runtime::connect("witness", gvom::ipc::test::kPatience).value();
  gvom::ipc::Topic topic = gvom::ipc::layers_topic();
  topic.queue = kQueue;
  auto layers = gvom::ipc::InPort::open(runtime, topic).value();
  while (true) {
    while (layers.take()) continue;
    told.received = layers.counters().received;
    told.lost = layers.counters().lost;
    std::this_thread::sleep_for(1ms);
  }
}

[[noreturn]] void hang_with_layers(Step& holds) {
  auto client = PlannerClient::connect("hangs").value();
  const auto first = client.newest_layers(gvom::ipc::test::kPatience, gvom::ipc::kAnyAge);
  const auto second = client.newest_layers(gvom::ipc::test::kPatience, gvom::ipc::kAnyAge);
  EXPECT(first && second);
  holds.reach(1);
  while (true) ::raise(SIGSTOP);
}

/// Joins under the name of a planner that was killed and leaves well: what that one held comes back.
void reclaim(const std::string& name) {
  Child heir([&] { EXPECT(PlannerClient::connect(name)); });
  CHECK(heir.wait() == 0);
}

std::vector<std::uint32_t> used_at_rest(Lab& lab) {
  lab.board->front = lab.board->rear = SensorMode::silent;
  std::this_thread::sleep_for(500ms);
  const auto used = lab.observer->used_chunks();
  lab.board->front = lab.board->rear = SensorMode::well;
  return used;
}

}  // namespace

TEST_CASE("a planner that hangs while it holds layers, and ten that crash again and again") {
  Lab lab({"ipc.max_planners=32"});  // room for the witness's queue as well
  Told& told = *shared_told();
  Child witness([&] { live_as_witness(told); });
  REQUIRE(eventually([&] { return told.received > 10; }));
  const auto before = used_at_rest(lab);
  REQUIRE(lab.layers_flow(20));

  Step holds;
  Child hung([&] { hang_with_layers(holds); });
  REQUIRE(holds.wait_for(1));
  const std::uint64_t received = told.received;
  CHECK(eventually([&] { return told.received >= received + 60; }));  // more than a planner's queue holds
  CHECK(told.lost == 0);
  CHECK(lab.drops_besides("gvom-fusion", "drop_map_too_old") == "");
  report("a planner hangs while it holds layers", "the others nothing", 0, "");

  std::minstd_rand random(1);
  const auto name = [](int i) { return "crasher-" + std::to_string(i); };
  std::vector<std::unique_ptr<Child>> crashers(kCrashers);
  const int kills = kCrashers * repeats(3);
  for (int kill = 0; kill < kills; ++kill) {
    auto& crasher = crashers[static_cast<std::size_t>(kill % kCrashers)];
    if (crasher) crasher->kill();
    crasher = std::make_unique<Child>([&] { live_as_planner(name(kill % kCrashers)); });
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 100));
  }
  for (auto& crasher : crashers) crasher->kill();
  const std::uint64_t through = told.received;
  CHECK(eventually([&] { return told.received >= through + 20; }));
  CHECK(told.lost == 0);
  CHECK(lab.drops_besides("gvom-fusion", "drop_map_too_old") == "");
  report("ten planners crash, " + std::to_string(kills) + " times", "the others nothing", 0, "");

  hung.kill();
  reclaim("hangs");
  for (int i = 0; i < kCrashers; ++i) reclaim(name(i));
  auto after = used_at_rest(lab);
  REQUIRE(after.size() == before.size());
  const auto are_back = [&] {
    return std::equal(after.begin(), after.end(), before.begin(),
                      [](std::uint32_t now, std::uint32_t then) { return now <= then + kStrayChunks; });
  };
  for (int i = 0; i < 3 && !are_back(); ++i) after = used_at_rest(lab);  // somebody may have paused with some
  for (std::size_t pool = 0; pool < after.size(); ++pool) {
    INFO("pool " << pool << ": " << before[pool] << " chunks before, " << after[pool] << " after");
    CHECK(after[pool] <= before[pool] + kStrayChunks);
  }
  lab.stop();
}
