// Joining the bus, and losing it.
#include <sys/stat.h>

#include <catch2/catch.hpp>

#include <fstream>

#include "ipc/fixed.hpp"
#include "tests/ipc/processes.hpp"

using namespace gvom;
using namespace gvom::ipc;
using namespace gvom::ipc::test;

namespace {

std::uint64_t file_bytes(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

/// Runs in a child, since joining is for good.
int exit_code_of(const std::function<void()>& life) {
  return Child(life).wait();
}

}  // namespace

TEST_CASE("without a broker joining fails within the timeout") {
  const int code = exit_code_of([] {
    const auto start = std::chrono::steady_clock::now();
    const auto runtime = Runtime::connect("lonely", 200ms);
    const auto took = std::chrono::steady_clock::now() - start;
    EXPECT(!runtime && runtime.error().kind == ErrorKind::unavailable);
    EXPECT(took >= 200ms && took < kPatience);
  });
  CHECK(code == 0);
}

TEST_CASE("a process waits for a broker that comes late") {
  Child early([] { EXPECT(Runtime::connect("early", kPatience)); });
  std::this_thread::sleep_for(100ms);
  BrokerProcess broker;
  CHECK(early.wait() == 0);
}

TEST_CASE("a bad name is refused before the broker hears of it") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  const int code = exit_code_of([] {
    EXPECT(Runtime::connect("two words", kPatience).error().kind == ErrorKind::bad_name);
    EXPECT(Runtime::connect("/slash", kPatience).error().kind == ErrorKind::bad_name);
    EXPECT(Runtime::connect("good", kPatience));
  });
  CHECK(code == 0);
}

TEST_CASE("the name of a living process cannot be taken, that of a dead one can") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step step;
  Child first([&] {
    auto runtime = Runtime::connect("twin", kPatience);
    EXPECT(runtime);
    EXPECT(Runtime::connect("other", kPatience).error().kind == ErrorKind::in_use);  // one for each process
    step.reach(1);
    std::this_thread::sleep_for(1h);
  });
  REQUIRE(step.wait_for(1));
  const auto join = [] { return Runtime::connect("twin", kPatience); };
  CHECK(exit_code_of([&] { EXPECT(join().error().kind == ErrorKind::in_use); }) == 0);
  CHECK(first.kill() == 128 + SIGKILL);
  CHECK(exit_code_of([&] { EXPECT(join()); }) == 0);
}

TEST_CASE("another user's left-over files are named, not tripped over") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  std::ofstream("/tmp/haunted.lock").put(' ');
  if (::chown("/tmp/haunted.lock", 1, 1) != 0) {
    WARN("SKIPPED: this user cannot give files away");
    return;
  }
  const int code = exit_code_of([] {
    const auto runtime = Runtime::connect("haunted", kPatience);
    EXPECT(!runtime && runtime.error().kind == ErrorKind::denied);
    EXPECT(runtime.error().message.find("/tmp/haunted.lock") != std::string::npos);
  });
  CHECK(code == 0);
}

TEST_CASE("a second broker is an error, and so are pools beyond the shared memory there is") {
  const auto start = [](const PoolPlan& plan) { return Broker::start({plan, {}, {}}); };
  PoolPlan plan = plan_pools(small_spec()).value();
  {
    BrokerProcess broker;
    REQUIRE(broker.is_up());
    CHECK(exit_code_of([&] { EXPECT(start(plan).error().kind == ErrorKind::in_use); }) == 0);
    CHECK(broker.stop() == 0);
  }
  plan.total_bytes = std::uint64_t{1} << 50;
  const int code = exit_code_of([&] {
    const auto broker = start(plan);
    EXPECT(!broker && broker.error().kind == ErrorKind::no_space);
    EXPECT(broker.error().message.find("bytes in /dev/shm") != std::string::npos);
  });
  CHECK(code == 0);
}

TEST_CASE("the memory that a broker asks for is enough, and not much more than it takes") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  const std::uint64_t taken = file_bytes("/dev/shm/iceoryx_mgmt") + file_bytes("/dev/shm/root");
  const std::uint64_t asked = shared_memory_bytes(plan_pools(small_spec()).value());
  CHECK(taken <= asked);
  CHECK(asked < taken + (16u << 20));
}

TEST_CASE("the loss of the broker is seen, even when another one comes") {
  auto broker = std::make_unique<BrokerProcess>();
  REQUIRE(broker->is_up());
  Step step;
  Child member([&] {
    auto runtime = Runtime::connect("member", kPatience).value();
    EXPECT(runtime.broker_alive());
    step.reach(1);
    EXPECT(step.wait_for(2));
    EXPECT(!runtime.broker_alive());
    step.reach(3);
    EXPECT(step.wait_for(4));
    EXPECT(!runtime.broker_alive());
  });
  REQUIRE(step.wait_for(1));
  CHECK(broker->kill() == 128 + SIGKILL);
  step.reach(2);
  REQUIRE(step.wait_for(3));
  broker = std::make_unique<BrokerProcess>();
  REQUIRE(broker->is_up());
  step.reach(4);
  CHECK(member.wait() == 0);
}

TEST_CASE("the payload segment is found and prefaulted") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  const int code = exit_code_of([] {
    auto runtime = Runtime::connect("member", kPatience).value();
    const auto segment = runtime.payload_segment().value();
    EXPECT(segment.bytes >= plan_pools(small_spec()).value().total_bytes);
    EXPECT(runtime.prefault().value() == segment.bytes);
    auto port = OutPort::open(runtime, topic_of<Odometry>()).value();
    const auto loan = port.loan(sizeof(Odometry)).value();
    EXPECT(loan.data() > segment.base && loan.data() < segment.base + segment.bytes);
  });
  CHECK(code == 0);
}

TEST_CASE("an error that the bus cannot go on from is told and ends the process with 70") {
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step told;
  const int code = exit_code_of([&] {
    const auto log = [&](const std::string& line) {
      if (line.find("INVALID_CHUNK_TO_SEND") != std::string::npos) told.reach(1);
    };
    auto runtime = Runtime::connect("unlucky", kPatience, log).value();
    auto one = OutPort::open(runtime, topic_of<Odometry>()).value();
    auto other = OutPort::open(runtime, topic_of<Odometry>()).value();
    other.publish(one.loan(sizeof(Odometry)).value(), sizeof(Odometry), 0, 0);  // not its own
  });
  CHECK(code == 70);
  CHECK(told.wait_for(1));
}

TEST_CASE("who makes a publisher when the broker is gone ends with 70, or with 0 if it is to stop anyway") {
  for (const bool to_stop : {false, true}) {
    auto broker = std::make_unique<BrokerProcess>();
    REQUIRE(broker->is_up());
    Step step;
    Child member([&] {
      auto runtime = Runtime::connect("member", kPatience, {}, [&] { return to_stop; }).value();
      step.reach(1);
      EXPECT(step.wait_for(2));
      const auto port = OutPort::open(runtime, topic_of<Odometry>());
      EXPECT(false);  // it does not come so far
    });
    REQUIRE(step.wait_for(1));
    CHECK(broker->kill() == 128 + SIGKILL);
    step.reach(2);
    CHECK(member.wait() == (to_stop ? 0 : 70));
  }
}

TEST_CASE("the broker's own loop feeds the watchdog at 10 Hz") {
  const int code = exit_code_of([] {
    std::atomic<int> beats{0};
    auto broker = Broker::start({plan_pools(small_spec()).value(), [&] { ++beats; }, {}});
    EXPECT(broker);
    EXPECT(eventually([&] { return beats >= 5; }));
  });
  CHECK(code == 0);
}
