// Brick maps and layers: written in the loaned chunk, read in place.
#include <catch2/catch.hpp>

#include <cmath>
#include <deque>
#include <numeric>

#include "ipc/brick_map.hpp"
#include "ipc/planner.hpp"
#include "ipc/text.hpp"
#include "tests/ipc/processes.hpp"

using namespace gvom;
using namespace gvom::ipc;
using namespace gvom::ipc::test;

namespace {

constexpr std::uint32_t kSlots = 256;
constexpr std::uint64_t kColumns[2] = {~std::uint64_t{0}, 0x7ff};  // 512 and 86 voxels were observed

void fill_grid(BrickMap& map) {
  map.grid.size[0] = map.grid.size[1] = 64;
  map.grid.size[2] = 32;
}

/// Two bricks, three records.
BrickMapWriter write_map(BrickMapPublisher& publisher) {
  auto map = publisher.loan({kSlots, 2, 3}).value();
  fill_grid(map.header());
  for (auto& entry : map.directory()) entry = -1;
  map.directory()[17] = 0;
  map.directory()[200] = 1;
  std::int32_t value = -600;
  for (auto& cell : map.lookup()) cell = value < -1 ? ++value : -1;
  for (int i = 0; i < 3; ++i) map.lookup()[i * 100] = i;
  map.columns()[0] = kColumns[0];
  map.columns()[1] = kColumns[1];
  for (int i = 0; i < 3; ++i) map.records()[i] = {7u + i, 11u + i, 0.25f * static_cast<float>(i)};
  return map;
}

BrickMapPublisher open_map_publisher(Runtime& runtime, const std::string& lidar) {
  return BrickMapPublisher::buffer_map(runtime, lidar, buffer_map_capacity(small_spec())).value();
}

LayersWriter write_layers(LayersPublisher& publisher, float height_m) {
  auto layers = publisher.loan(64, 32).value();
  for (auto& value : layers.layer_f(LayerId::height)) value = height_m;
  std::uint8_t cost = 0;
  for (auto& value : layers.layer_u8(LayerId::cost)) value = cost++;
  Layers& header = layers.header();
  header.grid.resolution_m[0] = header.grid.resolution_m[1] = header.grid.resolution_m[2] = 0.4;
  header.grid.origin[0] = -32;
  header.grid.origin[1] = 8;
  header.lidar_count = 2;
  set_text(header.lidars[0].name, "front");
  set_text(header.lidars[1].name, "rear");
  header.lidars[1].missing = 1;
  header.lidars[0].newest_stamp_ns = 1;
  header.lidars[0].columns_seen_fraction = 0.75F;
  header.mono_fused_ns = monotonic_ns() - 5'000'000;
  header.mono_received_ns = monotonic_ns() - 10'000'000;
  header.suspended_ns = suspended_ns();
  return layers;
}

/// Layers of packets that were received at `received_ns`, published now.
void publish_received_at(LayersPublisher& publisher, std::int64_t received_ns) {
  auto layers = write_layers(publisher, 1.0f);
  layers.header().mono_received_ns = received_ns;
  publisher.publish(std::move(layers), 7, 0);
}

}  // namespace

TEST_CASE("a brick map is read where it was written") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Child ingest([] {
    auto runtime = Runtime::connect("ingest", kPatience).value();
    auto publisher = open_map_publisher(runtime, "top");
    for (int i = 0; i < 100; ++i) EXPECT(publisher.loan({kSlots, 2, 3}));  // abandoned: all come back
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
                     EXPECT(!send([](auto& map) { map.header().grid.size[2] = 33; }));
                     EXPECT(subscriber.counters().refused_size == 4);
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
    EXPECT(publisher.loan({kSlots, 256, 20000}).error().kind == ErrorKind::too_large);
    auto boaster = BrickMapPublisher::buffer_map(runtime, "top", 1u << 30).value();
    EXPECT(boaster.loan({kSlots, 1, 1}).error().kind == ErrorKind::too_large);
    EXPECT(BrickMapPublisher::buffer_map(runtime, "Top", 1).error().kind == ErrorKind::bad_name);

    std::deque<BrickMapWriter> loans;
    for (int i = 0; i < 8; ++i) loans.push_back(publisher.loan({kSlots, 1, 1}).value());
    EXPECT(publisher.loan({kSlots, 1, 1}).error().kind == ErrorKind::exhausted);
    loans.clear();

    auto subscriber = BrickMapSubscriber::buffer_map(runtime, "top").value();
    EXPECT(eventually([&] { return publisher.has_subscribers(); }));
    std::deque<BrickMapSample> held;
    while (auto map = publisher.loan({kSlots, 0, 0})) {
      fill_grid(map->header());
      publisher.publish(std::move(*map), 0, 0);
      held.push_back(*subscriber.take());
      EXPECT(held.size() < 100);
    }
    EXPECT(publisher.loan({kSlots, 1, 1}).error().kind == ErrorKind::exhausted);
    held.pop_front();
    EXPECT(publisher.loan({kSlots, 1, 1}));
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
        auto map = lidar.publisher.loan({kSlots, 256, 10000});
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
      auto map = publisher.loan({kSlots, 0, 0});
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

TEST_CASE("who joins late gets the newest layers") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step step;
  Child fusion([&] {
    auto runtime = Runtime::connect("fusion", kPatience).value();
    auto publisher = LayersPublisher::open(runtime).value();
    for (const float height_m : {1.0f, 2.0f, 3.0f})
      publisher.publish(write_layers(publisher, height_m), 7, 0);
    step.reach(1);
    EXPECT(step.wait_for(2));
  });
  REQUIRE(step.wait_for(1));
  Child planner([&] {
    auto client = PlannerClient::connect("planner", kPatience).value();
    const auto layers = client.newest_layers(kPatience, kPatience);
    EXPECT(layers && layers->header().header.sequence == 3 && layers->size_xy() == 64);
    EXPECT(layers->layer_f(LayerId::height)[4095] == 3.0f && layers->layer_f(LayerId::height).size() == 4096);
    EXPECT(layers->layer_u8(LayerId::cost)[layers->at(2, 3)] == (3 * 64 + 2) % 256);
    EXPECT(layers->layer_u8(LayerId::height).empty() && layers->layer_f(LayerId::cost).empty());
    EXPECT(layers->index_of(-12.8, 3.2) == 0u && layers->index_of(-12.01, 3.7) == 65u);
    EXPECT(!layers->index_of(-12.9, 3.2) && !layers->index_of(12.8, 3.2) && !layers->index_of(NAN, 3.2));
    // 1.2 / 0.4 is below 3, 1.2 * (1 / 0.4) is 3 (R1); 4.8 / 0.4 is below 12.
    EXPECT(layers->index_of(1.2, 3.2) == layers->at(32 + 2, 0));
    EXPECT(layers->index_of(1.2, 4.8) == layers->at(32 + 2, 3));
    EXPECT(layers->missing_lidars() == std::vector<std::string>{"rear"});
    const auto incomplete = layers->incomplete_lidars();
    EXPECT(incomplete.size() == 1 && incomplete[0].name == "front");
    EXPECT(incomplete[0].columns_seen_fraction == 0.75);
    EXPECT(layers->publish_age() > 0ns && layers->publish_age() < kPatience);
    EXPECT(layers->stage_ages().fused > layers->publish_age() + 4ms && layers->stage_ages().mapped < 0ns);
    EXPECT(layers->age() > layers->publish_age() + 9ms && layers->age() < kPatience);
    EXPECT(client.newest_layers(50ms, kPatience).error().kind == ErrorKind::timeout);
    step.reach(2);
  });
  CHECK(planner.wait() == 0);
  CHECK(fusion.wait() == 0);
}

TEST_CASE("layers of old packets are an error that says how old, never a success") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Child both([] {
    auto client = PlannerClient::connect("planner", kPatience).value();
    auto publisher = LayersPublisher::open(client.runtime()).value();
    EXPECT(eventually([&] { return publisher.has_subscribers(); }));
    publish_received_at(publisher, monotonic_ns() - 2'059'000'000);
    const auto begin = std::chrono::steady_clock::now();
    const auto stale = client.newest_layers(1h);  // it does not wait for better ones
    EXPECT(!stale && stale.error().kind == ErrorKind::stale);
    const auto waited = std::chrono::steady_clock::now() - begin;
    EXPECT(stale.error().age >= 2059ms && stale.error().age < 2060ms + waited);
    EXPECT(stale.error().message.find("the newest layers are 2.") == 0);
    EXPECT(client.newest_layers(20ms).error().kind == ErrorKind::stale);  // nothing new: still so

    publish_received_at(publisher, monotonic_ns() - 2'059'000'000);
    EXPECT(client.newest_layers(kPatience, 1h));
    publish_received_at(publisher, monotonic_ns());
    EXPECT(client.newest_layers(kPatience, 1h));

    for (const std::int64_t never_ns : {std::int64_t{0}, monotonic_ns() + 3'600'000'000'000}) {
      publish_received_at(publisher, never_ns);
      const auto unknown = client.newest_layers(kPatience);
      EXPECT(!unknown && unknown.error().kind == ErrorKind::stale && unknown.error().age == kUnknownAge);
      publish_received_at(publisher, never_ns);
      EXPECT(client.newest_layers(kPatience, kAnyAge)->age() == kUnknownAge);
    }
  });
  CHECK(both.wait() == 0);
}

TEST_CASE("a planner that waits is told as soon as the last layers are too old") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Child both([] {
    auto client = PlannerClient::connect("planner", kPatience).value();
    auto publisher = LayersPublisher::open(client.runtime()).value();
    EXPECT(eventually([&] { return publisher.has_subscribers(); }));
    publish_received_at(publisher, monotonic_ns());
    EXPECT(client.newest_layers(kPatience, 1h));
    const auto stale = client.newest_layers(1h, 100ms);
    EXPECT(!stale && stale.error().kind == ErrorKind::stale && stale.error().age > 100ms);
  });
  CHECK(both.wait() == 0);
}

TEST_CASE("the first layers after joining are too old if fusion died a while ago") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step step;
  Child fusion([&] {
    auto runtime = Runtime::connect("fusion", kPatience).value();
    auto publisher = LayersPublisher::open(runtime).value();
    publish_received_at(publisher, monotonic_ns() - 4'000'000'000);
    step.reach(1);
    EXPECT(step.wait_for(2));
  });
  REQUIRE(step.wait_for(1));
  Child planner([&] {
    auto client = PlannerClient::connect("planner", kPatience).value();
    const auto layers = client.newest_layers(kPatience);
    EXPECT(!layers && layers.error().kind == ErrorKind::stale && layers.error().age >= 4s);
    step.reach(2);
  });
  CHECK(planner.wait() == 0);
  CHECK(fusion.wait() == 0);
}

TEST_CASE("a planner is told of layers of another gvom, and says so where it waits for them") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Child both([] {
    auto client = PlannerClient::connect("planner", kPatience).value();
    Topic former = layers_topic();
    --former.version;
    auto port = OutPort::open(client.runtime(), former).value();
    EXPECT(eventually([&] { return port.has_subscribers(); }));
    port.publish(port.loan(sizeof(Layers)).value(), sizeof(Layers), 0, 0);
    const auto layers = client.newest_layers(50ms);
    EXPECT(!layers && layers.error().kind == ErrorKind::timeout);
    EXPECT(layers.error().message ==
           "no new layers within 50 ms: layers: message of gvom 0.2 (version 1) refused, this is " +
               std::string(release()) + " (version 2)");
    EXPECT(client.counters().refused_version == 1);
  });
  CHECK(both.wait() == 0);
}

TEST_CASE("a planner takes the newest layers, knows what it missed, and sees the broker go") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step step;
  Child planner([&] {
    auto client = PlannerClient::connect("planner", kPatience).value();
    EXPECT(client.publish_odometry(Odometry{}, 1).value() == 1);
    auto publisher = LayersPublisher::open(client.runtime()).value();
    EXPECT(eventually([&] { return publisher.has_subscribers(); }));
    const auto send = [&](float height_m) { publisher.publish(write_layers(publisher, height_m), 0, 0); };
    send(1.0f);
    EXPECT(client.newest_layers(kPatience, kPatience)->layer_f(LayerId::height)[0] == 1.0f);
    for (int i = 2; i <= 9; ++i) send(static_cast<float>(i));
    EXPECT(client.newest_layers(kPatience, kPatience)->layer_f(LayerId::height)[0] == 9.0f);
    EXPECT(client.counters().lost == 8 - kLayersQueue);
    step.reach(1);
    const auto layers = client.newest_layers(kPatience, 1h);
    EXPECT(!layers && layers.error().kind == ErrorKind::unavailable);
  });
  REQUIRE(step.wait_for(1));
  CHECK(broker.kill() == 128 + SIGKILL);
  CHECK(planner.wait() == 0);
}
