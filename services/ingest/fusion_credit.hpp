// How many of our maps fusion has yet to take: what keeps a lossless replay from overrunning its queue.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

#include "ipc/messages.hpp"

namespace gvom::ingest {

class FusionCredit {
 public:
  explicit FusionCredit(std::string lidar) : lidar_(std::move(lidar)) {}

  void take(const ipc::Progress& progress) {
    if (std::strcmp(progress.reader, "fusion") != 0) return;
    for (std::uint32_t i = 0; i < progress.lidar_count && i < ipc::kMaxLidars; ++i)
      if (lidar_ == progress.taken[i].lidar) taken_ = progress.taken[i].sequence;
  }

  /// Whether another map fits fusion's queue of 16, by a wide margin.
  [[nodiscard]] bool has_room(std::uint64_t published) const { return published < taken_ + kMostWaiting; }

 private:
  static constexpr std::uint64_t kMostWaiting = 4;

  std::string lidar_;
  std::uint64_t taken_ = 0;
};

}  // namespace gvom::ingest
