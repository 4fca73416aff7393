#include "services/ingest/sweep_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gvom::ingest {

namespace {

constexpr std::chrono::milliseconds kPatience{50};  // how soon a stop is noticed
constexpr double kMostTurnsPerSecond = 20;
constexpr std::size_t kMostBytes = std::size_t{128} << 20;

}  // namespace

std::size_t queue_for(double timeout_s, std::size_t max_returns) {
  const auto wanted = static_cast<std::size_t>(std::ceil(timeout_s * kMostTurnsPerSecond)) + 1;
  const std::size_t bytes = max_returns * (sizeof(Return) + sizeof(std::int64_t));
  return std::max<std::size_t>(4, std::min(wanted, kMostBytes / bytes));
}

SweepReader::SweepReader(std::unique_ptr<Source> source, std::size_t max_returns, std::size_t queue,
                         std::function<void()> on_change)
    : source_(std::move(source)),
      live_(source_->is_live()),
      most_packets_per_s_(source_->most_packets_per_s()),
      on_change_(std::move(on_change)),
      sweeps_((live_ ? std::max(queue, kBacklog) : kBacklog) + 2),
      queue_(sweeps_.size()),
      warned_(source_->warnings().size()) {
  free_.reserve(sweeps_.size());
  for (Sweep& sweep : sweeps_) {
    sweep.returns.resize(max_returns);  // touched now, not when the loop first falls behind
    sweep.returns.clear();
    sweep.times_ns.reserve(max_returns);
    free_.push_back(&sweep);
  }
  thread_ = std::thread([this] { run(); });
}

SweepReader::~SweepReader() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

Sweep* SweepReader::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (queue_count_ == 0) return nullptr;
  ++taken_;
  return pop();
}

Sweep* SweepReader::pop() {
  Sweep* const sweep = queue_[queue_begin_];
  queue_begin_ = (queue_begin_ + 1) % queue_.size();
  --queue_count_;
  return sweep;
}

void SweepReader::give_back(Sweep* sweep) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    free_.push_back(sweep);
  }
  changed_.notify_all();
}

bool SweepReader::at_end() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return ended_ && !rewind_ && queue_count_ == 0;
}

std::optional<std::string> SweepReader::error() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return error_;
}

std::optional<std::string> SweepReader::new_warning() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (warnings_.empty()) return std::nullopt;
  std::string warning = std::move(warnings_.front());
  warnings_.erase(warnings_.begin());
  return warning;
}

void SweepReader::rewind() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    rewind_ = true;
    while (queue_count_ > 0) free_.push_back(pop());
  }
  changed_.notify_all();
}

SourceCounters SweepReader::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counters_;
}

SweepReader::Overruns SweepReader::overruns() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return overruns_;
}

bool SweepReader::wait_for_slot(std::unique_lock<std::mutex>& lock) {
  const auto ready = [this] { return stop_ || rewind_ || (!ended_ && (!free_.empty() || live_)); };
  changed_.wait(lock, ready);
  if (stop_) return false;
  if (rewind_) {
    rewind_ = false;
    ended_ = false;
    if (const auto rewound = source_->rewind(); !rewound) {
      error_ = rewound.error();
      ended_ = true;
    }
    return wait_for_slot(lock);
  }
  if (free_.empty()) make_room();
  return true;
}

/// Of a sensor: its oldest sweep goes.
void SweepReader::make_room() {
  free_.push_back(pop());
  ++(waiting_.load(std::memory_order_relaxed) ? overruns_.waiting : overruns_.slow);
}

/// What waits for the loop itself is kept short, since it ages: a longer queue, from a time without odometry,
/// may only shrink.
void SweepReader::push(Sweep* sweep) {
  const bool slow = live_ && !waiting_.load(std::memory_order_relaxed) && taken_ < 2;
  if (slow && queue_count_ >= kBacklog) make_room();
  taken_ = 0;
  queue_[(queue_begin_ + queue_count_++) % queue_.size()] = sweep;
}

void SweepReader::note_warnings() {
  const std::vector<std::string>& all = source_->warnings();
  while (warned_ < all.size()) warnings_.push_back(all[warned_++]);
}

void SweepReader::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (wait_for_slot(lock)) {
    Sweep* const sweep = free_.back();
    free_.pop_back();
    lock.unlock();
    if (const std::int64_t hint_ns = time_hint_ns_.load(std::memory_order_relaxed))
      source_->set_time_hint(hint_ns);
    const auto event = source_->next(*sweep, kPatience);
    lock.lock();
    counters_ = source_->counters();
    note_warnings();
    const bool whole = event && *event == SourceEvent::kSweep && !rewind_;
    if (whole) {
      push(sweep);
    } else {
      free_.push_back(sweep);
    }
    if (!event) error_ = event.error();
    ended_ = !event || *event == SourceEvent::kEnd;
    if (!whole && !ended_) continue;
    lock.unlock();
    on_change_();
    lock.lock();
  }
}

}  // namespace gvom::ingest
