// Reads sweeps in a thread of its own, so that a socket is emptied while the loop maps.
#pragma once

#include <array>
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

/// A bounded queue of sweeps between a source's thread and the loop. A recording waits when it is full; a
/// live sensor does not: its oldest sweep goes, counted.
class SweepReader {
 public:
  /// @param on_change called in the reader's thread when there is a sweep, an end or an error
  SweepReader(std::unique_ptr<Source> source, std::size_t max_returns, std::function<void()> on_change);
  ~SweepReader();
  SweepReader(const SweepReader&) = delete;
  SweepReader& operator=(const SweepReader&) = delete;

  /// Stamp of the oldest sweep in the queue.
  [[nodiscard]] std::optional<std::int64_t> front_stamp() const;
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
  /// Live sweeps that the loop was too slow for.
  [[nodiscard]] std::uint64_t overruns() const;

 private:
  static constexpr int kSlots = 6;  // one being read, one being mapped, four in the queue

  void run();
  bool wait_for_slot(std::unique_lock<std::mutex>& lock);
  void push(Sweep* sweep);
  void note_warnings();

  std::unique_ptr<Source> source_;
  const bool live_;
  const double most_packets_per_s_;
  std::function<void()> on_change_;
  std::array<Sweep, kSlots> sweeps_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::array<Sweep*, kSlots> free_{};
  int free_count_ = 0;
  std::array<Sweep*, kSlots> queue_{};
  int queue_begin_ = 0;
  int queue_count_ = 0;
  bool stop_ = false;
  bool rewind_ = false;
  bool ended_ = false;
  std::uint64_t overruns_ = 0;
  std::optional<std::string> error_;
  std::vector<std::string> warnings_;  // not taken yet
  std::size_t warned_;                 // of the source's, those that were noted
  SourceCounters counters_;
  std::atomic<std::int64_t> time_hint_ns_{0};
  std::thread thread_;
};

}  // namespace gvom::ingest
