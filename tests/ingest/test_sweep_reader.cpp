// The reader's thread and the loop at each other's throats; ThreadSanitizer watches in the preset "tsan".
#include <catch2/catch.hpp>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "services/ingest/sweep_reader.hpp"
#include "tests/ingest/counting_source.hpp"

using namespace gvom;
using namespace gvom::ingest;
using gvom::test::CountingSource;

namespace {

using std::chrono::milliseconds;

/// Where the loop sleeps until the reader calls.
class Bell {
 public:
  void ring() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      rung_ = true;
    }
    changed_.notify_one();
  }
  void wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, milliseconds(20), [this] { return rung_; });
    rung_ = false;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool rung_ = false;
};

struct Reading {
  Bell bell;
  SweepReader reader;
  Reading(bool live, std::int64_t sweeps)
      : reader(std::make_unique<CountingSource>(live, sweeps), CountingSource::kReturns, kQueue,
               [this] { bell.ring(); }) {}
  static constexpr std::size_t kQueue = 20;

  /// The stamp of the next sweep, which is looked at and given back; 0 at the end.
  std::int64_t next_stamp() {
    for (;;) {
      reader.set_time_hint(7);
      if (Sweep* const sweep = reader.take()) {
        const std::int64_t stamp_ns = sweep->stamp_ns;
        REQUIRE(sweep->returns.size() == CountingSource::kReturns);
        reader.give_back(sweep);
        return stamp_ns;
      }
      if (reader.at_end()) return 0;
      bell.wait();
    }
  }
};

}  // namespace

TEST_CASE("of a recording every sweep comes, in order, however slow the loop is") {
  constexpr std::int64_t kSweeps = 2000;
  Reading reading(false, kSweeps);
  for (std::int64_t i = 1; i <= kSweeps; ++i) {
    REQUIRE(reading.next_stamp() == i);
    if (i % 100 == 0) std::this_thread::sleep_for(milliseconds(1));
  }
  CHECK(reading.next_stamp() == 0);
  CHECK(reading.reader.overruns().slow == 0);
  CHECK(reading.reader.counters().sweeps == kSweeps);
  CHECK(reading.reader.new_warning() == "the end");
  CHECK_FALSE(reading.reader.new_warning());
}

TEST_CASE("rewound in the middle, or at its end, a recording begins again") {
  constexpr std::int64_t kSweeps = 20;
  Reading reading(false, kSweeps);
  for (std::int64_t round = 0; round < 300; ++round) {
    const std::int64_t taken = round % (kSweeps + 2);  // the last: up to the end
    for (std::int64_t i = 1; i <= taken; ++i) REQUIRE(reading.next_stamp() == (i > kSweeps ? 0 : i));
    reading.reader.rewind();
    CHECK_FALSE(reading.reader.at_end());
  }
  REQUIRE(reading.next_stamp() == 1);
}

TEST_CASE("of a sensor the oldest sweeps go when the loop is slow, each counted") {
  Reading reading(true, 0);
  std::int64_t taken = 0;
  std::int64_t last = 0;
  while (reading.reader.overruns().slow < 1000) {
    const std::int64_t stamp_ns = reading.next_stamp();
    REQUIRE(stamp_ns > last);
    last = stamp_ns;
    ++taken;
    std::this_thread::sleep_for(milliseconds(1));
  }
  const auto overruns = static_cast<std::int64_t>(reading.reader.overruns().slow);
  CHECK(last - taken <= overruns);
  CHECK(reading.reader.overruns().waiting == 0);
}

TEST_CASE("while the loop waits for odometry the whole queue fills, and what finds no room counts as that") {
  Reading reading(true, 0);
  reading.reader.set_waiting(true);
  const std::uint64_t slow = reading.reader.overruns().slow;  // it may have read on before
  while (reading.reader.overruns().waiting < 10) std::this_thread::sleep_for(milliseconds(1));
  CHECK(reading.reader.overruns().slow == slow);
  // Taken faster than new ones come, the long queue loses nothing more but what comes in between.
  std::int64_t last = 0;
  for (std::size_t i = 0; i < Reading::kQueue; ++i) {
    const std::int64_t stamp_ns = reading.next_stamp();
    REQUIRE(stamp_ns > last);
    last = stamp_ns;
  }
  // The loop is too slow now: the queue shrinks to what a slow loop may have.
  reading.reader.set_waiting(false);
  while (reading.reader.overruns().slow < slow + 1000) std::this_thread::sleep_for(milliseconds(1));
  const std::int64_t oldest = reading.next_stamp();
  CHECK(static_cast<std::int64_t>(reading.reader.counters().sweeps) - oldest >= 3);
}

TEST_CASE("the queue has room for the timeout at 20 turns a second, within bounds of memory") {
  CHECK(queue_for(1.0, 65536) == 21);
  CHECK(queue_for(0.01, 65536) == 4);
  CHECK(queue_for(1.0, 262144) == 12);
  CHECK(queue_for(60.0, 262144) == 12);
  CHECK(queue_for(1.0, 4194304) == 4);
}

TEST_CASE("a reader stops whatever it is doing: reading, or waiting for room") {
  for (int round = 0; round < 50; ++round) {
    for (const bool live : {false, true}) {
      Reading reading(live, 1000);
      for (int i = 0; i < round % 4; ++i) CHECK(reading.next_stamp() > 0);
      if (round % 2 == 0) std::this_thread::sleep_for(milliseconds(1));  // the queue is full
      if (round % 3 == 0 && !live) reading.reader.rewind();
    }
  }
}
