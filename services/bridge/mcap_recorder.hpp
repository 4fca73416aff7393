// The sink that writes MCAP files.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>

#include "services/bridge/sink.hpp"
#include "services/common/mcap/split_writer.hpp"

namespace gvom::bridge {

struct RecorderOptions {
  std::string folder;  ///< Made if it is not there.
  std::uint64_t split_bytes = 1ULL << 30;
  std::uint64_t min_free_bytes = 0;  ///< Of the disk, for everybody else; the recording ends before it.
  std::set<TopicId> topics;
  std::size_t most_waiting_bytes = 64U << 20;  ///< For a disk that is slow; more is dropped and counted.
};

/// Files are `FOLDER/gvom-DATE_000.mcap` and on, DATE of the start in UTC. A thread of its own packs and
/// writes; what was recorded until a second ago is in the file if the process is killed. A disk that is full,
/// or has less than min_free_bytes, ends the recording, and problem() says so; what was written stays
/// readable. What is said before the first data has no time (stamp 0) and is not recorded: the file would
/// begin in 1970.
class McapRecorder : public Sink {
 public:
  explicit McapRecorder(RecorderOptions options);
  /// Writes what waits, and finishes the file.
  ~McapRecorder() override;

  [[nodiscard]] std::string_view name() const override { return "mcap"; }
  [[nodiscard]] bool wants(const Topic& topic) const override;
  void offer(const Topic& topic, std::int64_t stamp_ns, const ros::Blob& message) override;
  [[nodiscard]] SinkCounters counters() const override;
  [[nodiscard]] std::string problem() const override;

 private:
  struct Waiting {
    TopicId topic;
    std::int64_t stamp_ns;
    ros::Blob message;
  };

  void record();
  bool take(std::deque<Waiting>& into);
  void write(const Waiting& waiting);
  void fail(const std::string& why);
  void leave_room();

  const RecorderOptions options_;
  mcap::SplitWriter writer_;
  std::map<TopicId, std::uint16_t> channels_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  std::size_t waiting_bytes_ = 0;
  SinkCounters counters_;
  std::string problem_;  // not empty: nothing is recorded any more
  bool done_ = false;
  std::thread thread_;
};

}  // namespace gvom::bridge
