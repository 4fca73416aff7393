// Reads sweeps in a thread of its own, so that a socket is emptied while the loop maps.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "services/ingest/source.hpp"

namespace gvom::ingest {

/// How many live sweeps a queue needs room for, so that each can wait `timeout_s` for odometry at 20 turns a
/// second; fewer, but at least four, if their memory would exceed 128 MiB.
std::size_t queue_for(double timeout_s, std::size_t max_returns);

/// A bounded queue of sweeps between a source's thread and the loop. A recording waits when it is full; a
/// live sensor does not: its oldest sweep goes, counted.
class SweepReader {
 public:
  /// @param queue   most live sweeps that wait for odometry; a recording's queue holds four
  /// @param on_change called in the reader's thread when there is a sweep, an end or an error
  SweepReader(std::unique_ptr<Source> source, std::size_t max_returns, std::size_t queue,
              std::function<void()> on_change);
  ~SweepReader();
  SweepReader(const SweepReader&) = delete;
  SweepReader& operator=(const SweepReader&) = delete;

  /// Takes the oldest sweep out; it is the caller's until `give_back`. Null if there is none.
  Sweep* take();
  void give_back(Sweep* sweep);

  /// A recording (or a broken source) gives no more sweeps and the queue is empty.
  [[nodiscard]] bool at_end() const;
  /// Why the source ended, if not in the normal way. Sweeps before it are in the queue.
  [[nodiscard]] std::optional<std::string> error() const;
  /// What the source wants a person to hear of, that it found only while it read; each once.
  std::optional<std::string> new_warning();
  /// A recording from its beginning again; what is in the queue is thrown away.
  void rewind();

  [[nodiscard]] bool is_live() const { return live_; }
  [[nodiscard]] double most_packets_per_s() const { return most_packets_per_s_; }
  void set_time_hint(std::int64_t stamp_ns) { time_hint_ns_.store(stamp_ns, std::memory_order_relaxed); }
  [[nodiscard]] SourceCounters counters() const;
  /// Whether the loop waits for odometry: then it is not too slow for the sweeps that pile up.
  void set_waiting(bool waiting) { waiting_.store(waiting, std::memory_order_relaxed); }
  struct Overruns {
    std::uint64_t slow = 0;     ///< Live sweeps that the loop was too slow for.
    std::uint64_t waiting = 0;  ///< ... that had no room while the loop waited for odometry.
  };
  [[nodiscard]] Overruns overruns() const;

 private:
  static constexpr std::size_t kBacklog = 4;  // sweeps that may wait for the loop itself

  void run();
  bool wait_for_slot(std::unique_lock<std::mutex>& lock);
  void push(Sweep* sweep);
  Sweep* pop();
  void make_room();
  void note_warnings();

  std::unique_ptr<Source> source_;
  const bool live_;
  const double most_packets_per_s_;
  std::function<void()> on_change_;
  std::vector<Sweep> sweeps_;  // one being read, one being mapped, the rest in the queue or free

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Sweep*> free_;
  std::vector<Sweep*> queue_;  // a ring
  std::size_t queue_begin_ = 0;
  std::size_t queue_count_ = 0;
  int taken_ = 0;  // by the loop, since the newest came
  bool stop_ = false;
  bool rewind_ = false;
  bool ended_ = false;
  Overruns overruns_;
  std::atomic<bool> waiting_{false};
  std::optional<std::string> error_;
  std::vector<std::string> warnings_;  // not taken yet
  std::size_t warned_;                 // of the source's, those that were noted
  SourceCounters counters_;
  std::atomic<std::int64_t> time_hint_ns_{0};
  std::thread thread_;
};

}  // namespace gvom::ingest
