// How many of our maps fusion has yet to take: what keeps a lossless replay from overrunning its queue.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "ipc/messages.hpp"
#include "ipc/text.hpp"

namespace gvom::ingest {

class FusionCredit {
 public:
  explicit FusionCredit(std::string lidar) : lidar_(std::move(lidar)) {}

  /// `published`: the newest of our maps. A fusion that began anew never gets those from before.
  void take(const ipc::Progress& progress, std::uint64_t published) {
    if (ipc::text_of(progress.reader) != "fusion") return;
    if (progress.header.sequence <= newest_progress_) missed_ = published;
    newest_progress_ = progress.header.sequence;
    for (std::uint32_t i = 0; i < progress.lidar_count && i < kMaxLidars; ++i)
      if (lidar_ == ipc::text_of(progress.taken[i].lidar)) taken_ = progress.taken[i].sequence;
  }

  /// Whether another map fits fusion's queue of 16, by a wide margin.
  [[nodiscard]] bool has_room(std::uint64_t published) const {
    const std::uint64_t taken = taken_ <= published ? taken_ : 0;  // else of an ingest that we replace
    return published < std::max(taken, missed_) + kMostWaiting;
  }

 private:
  static constexpr std::uint64_t kMostWaiting = 4;

  std::string lidar_;
  std::uint64_t taken_ = 0;
  std::uint64_t missed_ = 0;
  std::uint64_t newest_progress_ = 0;
};

}  // namespace gvom::ingest
