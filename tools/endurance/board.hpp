// Memory that the processes of gvom-soak share.
#pragma once

#include <sys/mman.h>

#include <atomic>
#include <cstdint>
#include <new>

#include "tools/endurance/notes.hpp"

namespace gvom::endurance {

/// How a lidar's packets are sent.
enum class SendMode : int {
  well,
  silent,
  loss,     ///< 3 of 10 are not sent.
  garbage,  ///< Ten datagrams of random sizes and bytes beside each.
};

struct Board {
  std::atomic<std::uint64_t> epoch{0};    ///< Of the newest odometry.
  std::atomic<std::int64_t> begin_ns{0};  ///< CLOCK_MONOTONIC of that epoch's first pose; set before it.
  std::atomic<bool> hold{true};           ///< No round of packets begins.
  PerLidar<std::atomic<SendMode>> modes{};
};

/// Shared with all children; null if the system refuses it.
inline Board* make_board() {
  void* const memory =
      ::mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  return memory == MAP_FAILED ? nullptr : new (memory) Board;
}

}  // namespace gvom::endurance
