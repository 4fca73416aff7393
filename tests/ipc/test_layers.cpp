// Layers: written in the loaned chunk, read in place, and never handed to a planner when they are stale.
#include <catch2/catch.hpp>

#include <cmath>
#include <utility>

#include "ipc/planner.hpp"
#include "ipc/text.hpp"
#include "tests/ipc/processes.hpp"

using namespace gvom;
using namespace gvom::ipc;
using namespace gvom::ipc::test;

namespace {

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

/// A planner, and a publisher that it hears, in one process.
std::pair<PlannerClient, LayersPublisher> both_ends() {
  auto client = PlannerClient::connect("planner", kPatience).value();
  auto publisher = LayersPublisher::open(client.runtime()).value();
  EXPECT(eventually([&] { return publisher.has_subscribers(); }));
  return {std::move(client), std::move(publisher)};
}

}  // namespace

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
    const auto publish_age = layers->publish_age();  // before the others: they grow meanwhile
    EXPECT(publish_age > 0ns && publish_age < kPatience);
    EXPECT(layers->stage_ages().fused > publish_age + 4ms && layers->stage_ages().mapped < 0ns);
    EXPECT(layers->age() > publish_age + 9ms && layers->age() < kPatience);
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
    auto [client, publisher] = both_ends();
    const std::int64_t received_ns = monotonic_ns() - 2'059'000'000;
    publish_received_at(publisher, received_ns);
    const auto stale = client.newest_layers(1h);  // it does not wait for better ones
    EXPECT(!stale && stale.error().kind == ErrorKind::stale);
    const std::chrono::nanoseconds at_most(monotonic_ns() - received_ns);
    EXPECT(stale.error().age >= 2059ms &&
           stale.error().age <= at_most + 1ms);  // 1: of suspended_ns(), whole ms
    EXPECT(stale.error().message == "the newest layers are " + age_words(stale.error().age));
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
    auto [client, publisher] = both_ends();
    bool told = false;
    for (int i = 0; i < 5 && !told; ++i) {  // where they are too old before it asks, it waits for others
      publish_received_at(publisher, monotonic_ns());
      EXPECT(client.newest_layers(kPatience, 1h));
      const auto begin = std::chrono::steady_clock::now();
      const auto stale = client.newest_layers(2s, 100ms);
      EXPECT(!stale && stale.error().kind == ErrorKind::stale && stale.error().age > 100ms);
      told = std::chrono::steady_clock::now() - begin < 2s;
    }
    EXPECT(told);
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
