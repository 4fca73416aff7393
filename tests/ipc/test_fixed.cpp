// Messages of fixed size between real processes.
#include <catch2/catch.hpp>

#include "ipc/fixed.hpp"
#include "ipc/text.hpp"
#include "ipc/waiter.hpp"
#include "tests/ipc/processes.hpp"

using namespace gvom;
using namespace gvom::ipc;
using namespace gvom::ipc::test;

namespace {

Odometry odometry_at(double x_m) {
  Odometry odometry{};
  odometry.T_odom_base.position_m[0] = x_m;
  odometry.T_odom_base.orientation_xyzw[3] = 1.0;
  return odometry;
}

/// Sends one Odometry-sized message on topic "odometry" as `topic` describes it.
void publish_as(Runtime& runtime, const Topic& topic, std::size_t bytes) {
  auto port = OutPort::open(runtime, topic).value();
  EXPECT(eventually([&] { return port.has_subscribers(); }));
  port.publish(port.loan(bytes).value(), bytes, 0, 0);
}

/// What a reader of Odometry says of the next message on its topic.
void expect_refusal(Step& step, std::uint64_t InCounters::*counter, const std::string& words) {
  auto runtime = Runtime::connect("reader", kPatience).value();
  auto subscriber = Subscriber<Odometry>::open(runtime).value();
  step.reach(1);
  EXPECT(eventually([&] { return !subscriber.take() && subscriber.counters().*counter == 1; }));
  const auto refusal = subscriber.new_refusal();
  std::fprintf(stderr, "%s\n", refusal.value_or("no refusal").c_str());
  EXPECT(refusal && refusal->find(words) != std::string::npos);
  EXPECT(!subscriber.new_refusal());
  EXPECT(subscriber.counters().received == 0);
}

}  // namespace

TEST_CASE("a message arrives in another process as it was sent") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Child sender([] {
    auto runtime = Runtime::connect("sender", kPatience).value();
    auto publisher = Publisher<Odometry>::open(runtime).value();
    EXPECT(eventually([&] { return publisher.has_subscribers(); }));
    EXPECT(publisher.publish(odometry_at(12.5), 1'000'000'007, 3).value() == 1);
    EXPECT(publisher.publish(odometry_at(13.5), 1'100'000'007, 3).value() == 2);
  });
  Child reader([] {
    auto runtime = Runtime::connect("reader", kPatience).value();
    auto subscriber = Subscriber<Odometry>::open(runtime).value();
    const auto first = take_within(subscriber);
    const auto second = take_within(subscriber);
    EXPECT(first && second);
    EXPECT(first->publisher() != 0 && first->publisher() == second->publisher());
    EXPECT((*first)->T_odom_base.position_m[0] == 12.5 && (*second)->T_odom_base.position_m[0] == 13.5);
    EXPECT((*first)->header.magic == kMagic && (*first)->header.version == Odometry::kVersion);
    EXPECT((*first)->header.size == sizeof(Odometry) && (*first)->header.epoch == 3);
    EXPECT((*first)->header.sequence == 1 && (*second)->header.sequence == 2);
    EXPECT((*first)->header.stamp_ns == 1'000'000'007);
    EXPECT(subscriber.counters().received == 2 && subscriber.counters().refused() == 0);
    EXPECT(subscriber.counters().lost == 0);
  });
  CHECK(sender.wait() == 0);
  CHECK(reader.wait() == 0);
}

TEST_CASE("a message of another version, type or size is refused by name and counted") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  struct Case {
    Topic topic;
    std::size_t bytes;
    std::uint64_t InCounters::*counter;
    std::string words;
  };
  Topic newer = topic_of<Odometry>();
  ++newer.version;
  Topic older = topic_of<Odometry>();
  --older.version;
  Topic other = topic_of<Odometry>();
  other.type = MessageType::health;
  const Case cases[] = {
      {newer, sizeof(Odometry), &InCounters::refused_version, "odometry: message of a newer gvom (version "},
      {older, sizeof(Odometry), &InCounters::refused_version, "odometry: message of "},
      {other, sizeof(Odometry), &InCounters::refused_type, "message type 5"},
      {topic_of<Odometry>(), sizeof(Odometry) + 8, &InCounters::refused_size, "bytes long, expected"}};
  for (const Case& c : cases) {
    Step step;
    Child reader([&] { expect_refusal(step, c.counter, c.words); });
    REQUIRE(step.wait_for(1));
    Child sender([&] {
      auto runtime = Runtime::connect("sender", kPatience).value();
      publish_as(runtime, c.topic, c.bytes);
    });
    CHECK(reader.wait() == 0);
    CHECK(sender.wait() == 0);
  }
}

TEST_CASE("a chunk that is not from gvom is refused") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step step;
  Child sender([&] {
    auto runtime = Runtime::connect("sender", kPatience).value();
    auto port = OutPort::open(runtime, topic_of<Odometry>()).value();
    EXPECT(eventually([&] { return port.has_subscribers(); }));
    auto loan = port.loan(sizeof(Odometry)).value();
    std::byte* const magic = loan.data();
    port.publish(std::move(loan), sizeof(Odometry), 0, 0);
    *magic = std::byte{0};  // the reader does not look before step 2
    step.reach(2);
  });
  Child reader([&] {
    auto runtime = Runtime::connect("reader", kPatience).value();
    auto subscriber = Subscriber<Odometry>::open(runtime).value();
    EXPECT(step.wait_for(2));
    EXPECT(!subscriber.take());
    EXPECT(subscriber.counters().refused_foreign == 1);
  });
  CHECK(sender.wait() == 0);
  CHECK(reader.wait() == 0);
}

TEST_CASE("what a full queue drops is counted, for each publisher on its own") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step step;
  Child sender([&] {
    auto runtime = Runtime::connect("sender", kPatience).value();
    auto one = Publisher<Health>::open(runtime).value();
    auto other = Publisher<Health>::open(runtime).value();
    const auto send = [](auto& publisher, int count) {
      for (int i = 0; i < count; ++i) EXPECT(publisher.publish(Health{}, 0, 0));
    };
    EXPECT(eventually([&] { return one.has_subscribers() && other.has_subscribers(); }));
    send(one, 1);
    send(other, 1);
    EXPECT(step.wait_for(1));
    send(one, 40);
    send(other, 50);
    send(one, 1);  // a gap shows when something follows it
    step.reach(2);
  });
  Child reader([&] {
    auto runtime = Runtime::connect("reader", kPatience).value();
    auto subscriber = Subscriber<Health>::open(runtime).value();
    EXPECT(take_within(subscriber) && take_within(subscriber));
    step.reach(1);
    EXPECT(step.wait_for(2));
    std::uint64_t rest = 0;
    while (subscriber.take()) ++rest;
    EXPECT(rest == kHealthQueue);
    EXPECT(subscriber.counters().lost == 40 + 50 + 1 - kHealthQueue);
    EXPECT(subscriber.counters().publishers == 2);
  });
  CHECK(sender.wait() == 0);
  CHECK(reader.wait() == 0);
}

TEST_CASE("a publisher killed and started again under its name is heard at once") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step step;
  Child reader([&] {
    auto runtime = Runtime::connect("reader", kPatience).value();
    auto subscriber = Subscriber<Odometry>::open(runtime).value();
    for (int life = 1; life <= 3; ++life) {
      const auto sample = take_within(subscriber);
      EXPECT(sample && (*sample)->T_odom_base.position_m[0] == life);
      step.reach(life);
    }
    EXPECT(subscriber.counters().publishers == 3 && subscriber.counters().lost == 0);
  });
  for (int life = 1; life <= 3; ++life) {
    Child sender([&] {
      auto runtime = Runtime::connect("sender", kPatience).value();
      auto publisher = Publisher<Odometry>::open(runtime).value();
      EXPECT(eventually([&] { return publisher.has_subscribers(); }));
      const auto held = OutPort::open(runtime, topic_of<Health>()).value().loan(sizeof(Health));
      EXPECT(publisher.publish(odometry_at(life), 0, 0));
      std::this_thread::sleep_for(1h);
    });
    CHECK(step.wait_for(life));
    CHECK(sender.kill() == 128 + SIGKILL);
  }
  CHECK(reader.wait() == 0);
}

TEST_CASE("a waiter wakes for data, for a call, and when the time is up") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step step;
  Child sender([&] {
    auto runtime = Runtime::connect("sender", kPatience).value();
    auto publisher = Publisher<Odometry>::open(runtime).value();
    EXPECT(step.wait_for(1));
    EXPECT(eventually([&] { return publisher.has_subscribers(); }));
    EXPECT(publisher.publish(odometry_at(1), 0, 0));
    EXPECT(step.wait_for(2));
  });
  Child reader([&] {
    auto runtime = Runtime::connect("reader", kPatience).value();
    auto odometry = Subscriber<Odometry>::open(runtime).value();
    auto health = Subscriber<Health>::open(runtime).value();
    auto waiter = Waiter::create(runtime);
    waiter.add(odometry);
    waiter.add(health);
    EXPECT(waiter.wait(20ms) == WaitResult::timeout);
    step.reach(1);
    EXPECT(waiter.wait(kPatience) == WaitResult::data);
    EXPECT(waiter.wait(0ms) == WaitResult::data);  // still unread
    EXPECT(odometry.take());
    EXPECT(waiter.wait(1ms) == WaitResult::timeout);
    std::thread caller([&] { waiter.wake(); });
    EXPECT(waiter.wait(kPatience) == WaitResult::woken);
    caller.join();
    waiter.wake();  // nobody waits yet
    EXPECT(waiter.wait(kPatience) == WaitResult::woken);
    EXPECT(waiter.wait(1ms) == WaitResult::timeout);
    step.reach(2);
  });
  CHECK(reader.wait() == 0);
  CHECK(sender.wait() == 0);
}
