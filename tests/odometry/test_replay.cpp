// gvom-odometry as a process on a real bus, with stand-ins for its readers.
#include <catch2/catch.hpp>

#include <fstream>
#include <optional>
#include <sstream>

#include "ipc/fixed.hpp"
#include "ipc/runtime.hpp"
#include "tests/ipc/processes.hpp"
#include "tests/odometry/fake_readers.hpp"

using namespace gvom;
using namespace gvom::ipc;
using namespace gvom::ipc::test;
using namespace gvom::test;
using Catch::Contains;

namespace {

constexpr char kVehicle[] = "/tmp/vehicle.yaml";
constexpr char kRecording[] = "/tmp/odometry.tum";
constexpr char kOutput[] = "/tmp/gvom-odometry.out";
constexpr int kPoses = 100;

void write_inputs(int poses = kPoses) {
  std::ofstream(kVehicle) << "name: test\n"
                             "odometry: {source: tum:/tmp/odometry.tum}\n"
                             "lidars:\n"
                             "  front: &l {T_base_sensor: {x: 0, y: 0, z: 2, roll: 0, pitch: 0, yaw: 0}}\n"
                             "  rear: *l\n";
  std::ofstream recording(kRecording);
  for (int i = 0; i < poses; ++i)
    recording << 1000 + i / 100 << "." << i / 10 % 10 << i % 10 << " " << i << " 0 0 0 0 0 1\n";
}

/// gvom-odometry with these arguments after --config.
std::function<void()> odometry(std::vector<const char*> arguments) {
  return [arguments] {
    const int output = ::open(kOutput, O_CREAT | O_TRUNC | O_WRONLY, 0600);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    std::vector<const char*> argv = {"gvom-odometry", "--config", kVehicle};
    argv.insert(argv.end(), arguments.begin(), arguments.end());
    argv.push_back(nullptr);
    ::execv(GVOM_ODOMETRY, const_cast<char* const*>(argv.data()));
    ::_exit(127);
  };
}

std::string output() {
  std::ostringstream text;
  text << std::ifstream(kOutput).rdbuf();
  return text.str();
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

TEST_CASE("at --rate max every reader gets every message, and the end waits for the maps") {
  write_inputs();
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step done;
  Child front(lossless_ingest("front", done, 0ms, kPoses));
  Child rear(lossless_ingest("rear", done, 3ms, kPoses));
  Child fused(fusion(done, 7));
  Child replay(odometry({"--rate", "max"}));
  const int code = replay.wait();
  done.reach(1);
  INFO(output());
  CHECK(code == 0);
  CHECK(front.wait() == 0);
  CHECK(rear.wait() == 0);
  CHECK_THAT(output(), Contains("101 odometry messages") && Contains("1 whole rounds of 100 poses") &&
                           Contains("14 maps"));
}

TEST_CASE("at --rate 2 one second of recording takes half a second, and no less") {
  write_inputs();
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step done;
  Step ready;
  Child front(ingest("front", done));
  Child rear(ingest("rear", done));
  Child fused(fusion(done));
  Child listener([&] {
    auto runtime = Runtime::connect("listener", kPatience).value();
    auto subscriber = Subscriber<Odometry>::open(runtime).value();
    const std::int64_t before_ns = monotonic_ns();
    ready.reach(1);
    const auto first = take_within(subscriber);
    EXPECT(first);
    for (int i = 1; i < kPoses; ++i) {
      const auto next = take_within(subscriber);
      EXPECT(next);
      EXPECT(((*next)->flags & Odometry::kLossless) == 0);
      const std::int64_t due_ns = ((*next)->header.stamp_ns - (*first)->header.stamp_ns) / 2;
      EXPECT(due_ns == i * 5'000'000LL);
      EXPECT(monotonic_ns() - before_ns >= due_ns);  // never early; how late, a busy machine decides
    }
  });
  REQUIRE(ready.wait_for(1));
  Child replay(odometry({"--rate", "2"}));
  CHECK(replay.wait() == 0);
  CHECK(listener.wait() == 0);
  done.reach(1);
}

TEST_CASE("a lossless replay names the readers that are missing and asks to be tried again") {
  write_inputs();
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step done;
  Step joined;
  Child front(ingest("front", done, 0, &joined));
  REQUIRE(joined.wait_for(1));
  Child replay(odometry({"--rate", "max", "--wait-readers", "3"}));
  CHECK(replay.wait() == 75);
  CHECK_THAT(output(), Contains("no sign within 3.0 s of: rear, fusion"));
  done.reach(1);
}

TEST_CASE("a paced replay starts without them and ends") {
  write_inputs(20);
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Child replay(odometry({"--wait-readers", "0.2"}));
  CHECK(replay.wait() == 0);
  CHECK_THAT(output(), Contains("no sign within 0.2 s of: front, rear, fusion; starting without"));
}

TEST_CASE("a paced replay does not wait for what lies behind a stamp of 0") {
  write_inputs(20);
  std::ostringstream poses;
  poses << std::ifstream(kRecording).rdbuf();
  std::ofstream(kRecording) << "0 0 0 0 0 0 0 1\n" << poses.str();
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Child replay(odometry({"--wait-readers", "0", "--rate", "20"}));
  CHECK(replay.wait() == 0);
  CHECK_THAT(output(),
             Contains("the odometry pauses for 1000.0 s after 0.000 s: going on after 10 s of them") &&
                 Contains("22 odometry messages"));
}

TEST_CASE("a reader that stands still stops a lossless replay after 10 s, by name") {
  write_inputs();
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step done;
  Child front(ingest("front", done));
  Child rear(ingest("rear", done, 20));
  Child fused(fusion(done));
  const auto begin = std::chrono::steady_clock::now();
  Child replay(odometry({"--rate", "max"}));
  CHECK(replay.wait() == 75);
  CHECK(seconds_since(begin) > 9.9);
  CHECK_THAT(output(), Contains("no progress for 10 s: 'rear' is at odometry 20 of 52"));
  done.reach(1);
}

TEST_CASE("--loop begins again in a higher epoch, until a SIGTERM") {
  write_inputs(5);
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Step done;
  Step ready;
  Child front(ingest("front", done));
  Child rear(ingest("rear", done));
  Child fused(fusion(done));
  Child listener([&] {
    auto runtime = Runtime::connect("listener", kPatience).value();
    auto subscriber = Subscriber<Odometry>::open(runtime).value();
    ready.reach(1);
    std::uint64_t epoch = 0;
    for (int i = 0; i < 18; ++i) {  // three rounds of five poses and an end
      const auto odometry = take_within(subscriber);
      EXPECT(odometry);
      EXPECT((*odometry)->header.sequence == static_cast<std::uint64_t>(i) + 1);
      EXPECT(i % 6 == 0 ? (*odometry)->header.epoch > epoch : (*odometry)->header.epoch == epoch);
      EXPECT(((*odometry)->flags & Odometry::kEndOfStream) == (i % 6 == 5 ? Odometry::kEndOfStream : 0u));
      epoch = (*odometry)->header.epoch;
    }
  });
  REQUIRE(ready.wait_for(1));
  Child replay(odometry({"--loop", "--rate", "0.25"}));  // slow, or a listener that pauses loses some
  CHECK(listener.wait() == 0);
  replay.send(SIGTERM);
  const auto begin = std::chrono::steady_clock::now();
  CHECK(replay.wait() == 0);
  CHECK(seconds_since(begin) < 10);
  done.reach(1);
}

TEST_CASE("a stop is obeyed while it waits for the broker and while it waits for readers") {
  write_inputs();
  for (const bool has_broker : {false, true}) {
    std::optional<BrokerProcess> broker;
    if (has_broker) broker.emplace();
    Child replay(odometry({"--wait-readers", "60"}));
    REQUIRE(takes_signals(replay.pid()));
    std::this_thread::sleep_for(500ms);
    replay.send(SIGINT);
    const auto begin = std::chrono::steady_clock::now();
    CHECK(replay.wait() == 0);
    CHECK(seconds_since(begin) < 10);
  }
}

TEST_CASE("when the broker dies it leaves with 75") {
  write_inputs();
  BrokerProcess broker;
  REQUIRE(broker.is_up());
  Child replay(odometry({"--wait-readers", "60"}));
  Child listener([] {
    auto runtime = Runtime::connect("listener", kPatience).value();
    auto health = Subscriber<Health>::open(runtime).value();
    EXPECT(take_within(health));
  });
  REQUIRE(listener.wait() == 0);  // the replay has joined
  broker.kill();
  CHECK(replay.wait() == 75);
  CHECK_THAT(output(), Contains("the broker is gone"));
}

TEST_CASE("bad input is refused before anything starts") {
  write_inputs();
  const auto code_of = [](std::vector<const char*> arguments) { return Child(odometry(arguments)).wait(); };
  CHECK(code_of({"--source", "tum:/nonexistent.tum"}) == 65);
  CHECK_THAT(output(), Contains("/nonexistent.tum: No such file or directory"));
  std::ofstream("/tmp/bad.tum") << "1 0 0 0 0 0 0 1\n2 nan 0 0 0 0 0 1\n";
  CHECK(code_of({"--source", "tum:/tmp/bad.tum"}) == 65);
  CHECK_THAT(output(), Contains("/tmp/bad.tum:2: expected a finite number, found 'nan'"));
  std::ofstream("/tmp/bad.tum") << "2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n";
  CHECK(code_of({"--source", "tum:/tmp/bad.tum"}) == 65);
  CHECK_THAT(output(), Contains("/tmp/bad.tum:2: expected time to go on"));
  CHECK(code_of({"--rate", "0"}) == 64);
  CHECK(code_of({"--set", "odometry.source="}) == 78);
  CHECK(code_of({"--set", "odometry.sorce=x"}) == 78);
  CHECK(code_of({"--check"}) == 0);
}
