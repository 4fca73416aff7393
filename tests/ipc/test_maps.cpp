// Brick maps: written in the loaned chunk, read in place.
#include <catch2/catch.hpp>

#include <deque>
#include <numeric>

#include "ipc/brick_map.hpp"
#include "ipc/text.hpp"
#include "tests/ipc/processes.hpp"

using namespace gvom;
using namespace gvom::ipc;
using namespace gvom::ipc::test;

namespace {

constexpr std::uint32_t kSlots = 256;
constexpr std::uint32_t kGridColumns = 64 * 64;
constexpr std::uint64_t kColumns[2] = {~std::uint64_t{0}, 0x7ff};  // 512 and 86 voxels were observed

void fill_grid(BrickMap& map) {
  map.grid.size[0] = map.grid.size[1] = 64;
  map.grid.size[2] = 32;
  map.grid.resolution_m = {0.4, 0.4, 0.4};
}

/// Two bricks, three records.
BrickMapWriter write_map(BrickMapPublisher& publisher) {
  auto map = publisher.loan({kSlots, 2, 3, kGridColumns}).value();
  fill_grid(map.header());
  for (auto& entry : map.directory()) entry = -1;
  map.directory()[17] = 0;
  map.directory()[200] = 1;
  std::int32_t value = -600;
  for (auto& cell : map.lookup()) cell = value < -1 ? ++value : -1;
  for (int i = 0; i < 3; ++i) map.lookup()[i * 100] = i;
  map.columns()[0] = kColumns[0];
  map.columns()[1] = kColumns[1];
  for (auto& lowest_m : map.lowest_ray_m()) lowest_m = kNoRay_m;
  map.lowest_ray_m()[99] = -1.5f;
  for (int i = 0; i < 3; ++i) map.records()[i] = {7u + i, 11u + i, 0.25f * static_cast<float>(i)};
  return map;
}

BrickMapPublisher open_map_publisher(Runtime& runtime, const std::string& lidar) {
  return BrickMapPublisher::buffer_map(runtime, lidar, buffer_map_capacity(small_spec())).value();
}

}  // namespace

TEST_CASE("a brick map is read where it was written") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Child ingest([] {
    auto runtime = Runtime::connect("ingest", kPatience).value();
    auto publisher = open_map_publisher(runtime, "top");
    for (int i = 0; i < 100; ++i)
      EXPECT(publisher.loan({kSlots, 2, 3, kGridColumns}));  // abandoned: all come back
    EXPECT(eventually([&] { return publisher.has_subscribers(); }));
    publisher.publish(write_map(publisher), 123, 4);
  });
  Child fusion([] {
    auto runtime = Runtime::connect("fusion", kPatience).value();
    auto subscriber = BrickMapSubscriber::buffer_map(runtime, "top").value();
    const auto map = take_within(subscriber);
    EXPECT(map && map->validate_deep());
    const BrickMap& header = map->header();
    EXPECT(text_of(header.lidar) == "top" && header.header.stamp_ns == 123 && header.header.epoch == 4);
    EXPECT(header.mono_published_ns > 0 && header.mono_published_ns <= monotonic_ns());
    EXPECT(map->directory().size() == kSlots && map->directory()[17] == 0 && map->directory()[200] == 1);
    EXPECT(std::accumulate(map->directory().begin(), map->directory().end(), 0) == 1 - 254);
    EXPECT(map->lookup().size() == 1024 && map->lookup()[1] == -598 && map->lookup()[200] == 2);
    EXPECT(map->columns()[0] == kColumns[0] && map->columns()[1] == kColumns[1]);
    EXPECT(map->lowest_ray_m().size() == kGridColumns && map->lowest_ray_m()[98] == kNoRay_m &&
           map->lowest_ray_m()[99] == -1.5f);
    EXPECT(map->records().size() == 3 && map->records()[2].passes == 13 &&
           map->records()[2].min_height_m == 0.5f);
    const auto segment = runtime.payload_segment().value();
    const auto* where = reinterpret_cast<const std::byte*>(&header);
    EXPECT(where > segment.base && where < segment.base + segment.bytes);
  });
  CHECK(ingest.wait() == 0);
  CHECK(fusion.wait() == 0);
}

TEST_CASE("a map that contradicts itself is refused") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  const int code = Child([] {
                     auto runtime = Runtime::connect("both", kPatience).value();
                     auto publisher = open_map_publisher(runtime, "top");
                     auto subscriber = BrickMapSubscriber::buffer_map(runtime, "top").value();
                     EXPECT(eventually([&] { return publisher.has_subscribers(); }));
                     const auto send = [&](const auto& spoil) {
                       auto map = write_map(publisher);
                       spoil(map);
                       publisher.publish(std::move(map), 0, 0);
                       return subscriber.take();
                     };
                     EXPECT(send([](auto&) {}));
                     EXPECT(!send([](auto& map) { map.header().shape.record_count = 4; }));
                     EXPECT(!send([](auto& map) { map.header().shape.brick_count = 257; }));
                     EXPECT(!send([](auto& map) { map.header().shape.brick_slots = 255; }));
                     EXPECT(!send([](auto& map) { map.header().shape.column_count = 4095; }));
                     EXPECT(!send([](auto& map) { map.header().grid.size[2] = 33; }));
                     EXPECT(subscriber.counters().refused_size == 5);
                     EXPECT(!send([](auto& map) { map.directory()[0] = 2; })->validate_deep());
                   }).wait();
  CHECK(code == 0);
}

TEST_CASE("loans that cannot be are errors, not the end") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Child process([] {
    auto runtime = Runtime::connect("both", kPatience).value();
    auto publisher = open_map_publisher(runtime, "top");
    EXPECT(publisher.loan({kSlots, 256, 20000, kGridColumns}).error().kind == ErrorKind::too_large);
    auto boaster = BrickMapPublisher::buffer_map(runtime, "top", 1u << 30).value();
    EXPECT(boaster.loan({kSlots, 1, 1, kGridColumns}).error().kind == ErrorKind::too_large);
    EXPECT(BrickMapPublisher::buffer_map(runtime, "Top", 1).error().kind == ErrorKind::bad_name);

    std::deque<BrickMapWriter> loans;
    for (int i = 0; i < 8; ++i) loans.push_back(publisher.loan({kSlots, 1, 1, kGridColumns}).value());
    EXPECT(publisher.loan({kSlots, 1, 1, kGridColumns}).error().kind == ErrorKind::exhausted);
    loans.clear();

    auto subscriber = BrickMapSubscriber::buffer_map(runtime, "top").value();
    EXPECT(eventually([&] { return publisher.has_subscribers(); }));
    std::deque<BrickMapSample> held;
    while (auto map = publisher.loan({kSlots, 0, 0, kGridColumns})) {
      fill_grid(map->header());
      publisher.publish(std::move(*map), 0, 0);
      held.push_back(*subscriber.take());
      EXPECT(held.size() < 100);
    }
    EXPECT(publisher.loan({kSlots, 1, 1, kGridColumns}).error().kind == ErrorKind::exhausted);
    held.pop_front();
    EXPECT(publisher.loan({kSlots, 1, 1, kGridColumns}));
  });
  CHECK(process.wait() == 0);
}

TEST_CASE("the pools suffice for full queues and full windows of the largest maps") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Child process([] {
    auto runtime = Runtime::connect("both", kPatience).value();
    struct Lidar {
      BrickMapPublisher publisher;
      BrickMapSubscriber subscriber;
      std::deque<BrickMapSample> window;
    };
    std::deque<Lidar> lidars;
    for (const std::string name : {"front", "rear"}) {
      lidars.push_back(
          {open_map_publisher(runtime, name), BrickMapSubscriber::buffer_map(runtime, name).value(), {}});
    }
    for (int sweep = 0; sweep < 200; ++sweep) {
      for (Lidar& lidar : lidars) {
        EXPECT(eventually([&] { return lidar.publisher.has_subscribers(); }));
        auto map = lidar.publisher.loan({kSlots, 256, 10000, kGridColumns});
        EXPECT(map);
        fill_grid(map->header());
        lidar.publisher.publish(std::move(*map), sweep, 0);
        if (sweep % 2 == 0) lidar.window.push_back(*lidar.subscriber.take());  // the queue fills up
        while (lidar.window.size() > 5) lidar.window.pop_front();
      }
    }
    EXPECT(lidars[0].subscriber.counters().lost > 0 &&
           !lidars[0].window.front().validate_deep());  // arrays were never written
  });
  CHECK(process.wait() == 0);
}

TEST_CASE("a reader killed with its hands full takes nothing to the grave") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step life;
  Child ingest([&] {
    auto runtime = Runtime::connect("ingest", kPatience).value();
    auto publisher = open_map_publisher(runtime, "top");
    while (!life.reached(20)) {
      auto map = publisher.loan({kSlots, 0, 0, kGridColumns});
      EXPECT(map);
      fill_grid(map->header());
      publisher.publish(std::move(*map), 0, 0);
      std::this_thread::sleep_for(1ms);
    }
  });
  for (int i = 1; i <= 20; ++i) {
    Child fusion([&] {
      auto runtime = Runtime::connect("fusion", kPatience).value();
      auto subscriber = BrickMapSubscriber::buffer_map(runtime, "top").value();
      std::deque<BrickMapSample> window;
      while (window.size() < 5) window.push_back(take_within(subscriber).value());
      life.reach(i);
      std::this_thread::sleep_for(1h);
    });
    REQUIRE(life.wait_for(i));
    std::this_thread::sleep_for(30ms);  // its queue fills up
    CHECK(fusion.kill() == 128 + SIGKILL);
  }
  CHECK(ingest.wait() == 0);
}
