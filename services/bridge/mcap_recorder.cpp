#include "services/bridge/mcap_recorder.hpp"

#include <spdlog/fmt/fmt.h>
#include <chrono>
#include <ctime>
#include <filesystem>

#include "services/bridge/mcap_channels.hpp"

namespace gvom::bridge {
namespace {

/// Of files that are not there yet: where no clock survives a reboot, the same time comes again.
std::string new_stem_in(const std::string& folder) {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  char date[32];
  std::strftime(date, sizeof date, "%Y%m%d-%H%M%S", &utc);
  const std::string stem = folder + "/gvom-" + date;
  std::string free = stem;
  std::error_code ignored;
  for (int i = 2; std::filesystem::exists(free + "_000.mcap", ignored); ++i)
    free = stem + "-" + std::to_string(i);
  return free;
}

}  // namespace

McapRecorder::McapRecorder(RecorderOptions options)
    : options_(std::move(options)), writer_(new_stem_in(options_.folder), options_.split_bytes) {
  for (const TopicId id : options_.topics) channels_[id] = writer_.add_channel(mcap_channel(topic(id)));
  std::error_code error;
  std::filesystem::create_directories(options_.folder, error);
  if (error) problem_ = options_.folder + ": " + error.message() + " (bridge.mcap.folder)";
  leave_room();
  thread_ = std::thread([this] { record(); });
}

McapRecorder::~McapRecorder() {
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

bool McapRecorder::wants(const Topic& topic) const {
  if (options_.topics.count(topic.id) == 0) return false;
  const std::lock_guard lock(mutex_);
  return problem_.empty();
}

void McapRecorder::offer(const Topic& topic, std::int64_t stamp_ns, const ros::Blob& message) {
  if (stamp_ns == 0) return;
  {
    const std::lock_guard lock(mutex_);
    if (!problem_.empty() || waiting_bytes_ + message->size() > options_.most_waiting_bytes) {
      ++counters_.dropped;
      return;
    }
    waiting_bytes_ += message->size();
    waiting_.push_back({topic.id, stamp_ns, message});
  }
  changed_.notify_all();
}

SinkCounters McapRecorder::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

std::string McapRecorder::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

void McapRecorder::fail(const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (!problem_.empty()) return;
  problem_ = why + ": nothing more is recorded until a restart";
  counters_.dropped += waiting_.size();
  waiting_.clear();
  waiting_bytes_ = 0;
}

/// What waits, after at most a second of waiting for it; false if it is the last.
bool McapRecorder::take(std::deque<Waiting>& into) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::seconds(1), [this] { return done_ || !waiting_.empty(); });
  into.swap(waiting_);
  waiting_bytes_ = 0;
  return !done_;
}

void McapRecorder::write(const Waiting& waiting) {
  const auto written = writer_.write(channels_.at(waiting.topic), waiting.stamp_ns, *waiting.message);
  if (!written) fail(written.error());
  const std::lock_guard lock(mutex_);
  ++(written ? counters_.sent : counters_.dropped);
  if (written) counters_.bytes += waiting.message->size();
}

/// Once a second: less than that is written in between by far.
void McapRecorder::leave_room() {
  std::error_code error;  // a folder that is gone is told by who writes into it
  const std::filesystem::space_info space = std::filesystem::space(options_.folder, error);
  if (error || space.available >= options_.min_free_bytes) return;
  fail(fmt::format("{}: {} MB of the disk are free, {} MB are left to others (bridge.mcap.min_free_mb)",
                   options_.folder, space.available / 1'000'000, options_.min_free_bytes / 1'000'000));
}

void McapRecorder::record() {
  auto flushed = std::chrono::steady_clock::now();
  for (bool more = true; more;) {
    std::deque<Waiting> taken;
    more = take(taken);
    for (const Waiting& one : taken) write(one);
    const auto now = std::chrono::steady_clock::now();
    if (now - flushed < std::chrono::seconds(1)) continue;
    flushed = now;
    if (const auto done = writer_.flush(); !done) fail(done.error());
    leave_room();
  }
  if (const auto closed = writer_.close(); !closed) fail(closed.error());
}

}  // namespace gvom::bridge
