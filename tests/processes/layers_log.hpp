// A process that keeps all layers that fusion publishes, for a test to look at when all is over.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "ipc/messages.hpp"
#include "tests/ipc/processes.hpp"

namespace gvom::test {

/// Of one message: the header, and what columns of small_map() show, [y][x].
struct LoggedLayers {
  static constexpr int kSize = 128;
  static constexpr std::size_t kColumns = std::size_t{kSize} * kSize;

  ipc::Layers header;
  std::array<float, kColumns> last_seen_s;
  std::array<std::uint8_t, kColumns> visibility;
  std::array<std::uint8_t, kColumns> cost;

  /// When a column was last seen, by the sensors' clock; only where `last_seen_s` is known.
  [[nodiscard]] std::int64_t seen_ns(std::size_t column) const;
  [[nodiscard]] const ipc::LidarStatus& lidar(const char* name) const;
};

/// To set where a LayersLog reads: its queue holds the layers of seconds.
inline constexpr const char* kRoomForLayersLog = "ipc.max_planners=32";

class LayersLog {
 public:
  /// Joins the bus, whose pools have room for it; on it when the constructor returns.
  LayersLog();
  ~LayersLog();
  LayersLog(const LayersLog&) = delete;
  LayersLog& operator=(const LayersLog&) = delete;

  [[nodiscard]] bool is_up() const { return up_; }
  [[nodiscard]] std::size_t size() const { return pages_->count; }
  const LoggedLayers& operator[](std::size_t i) const { return pages_->layers[i]; }
  [[nodiscard]] const LoggedLayers& newest() const { return pages_->layers[size() - 1]; }
  /// Waits for layers of which `condition` holds; false if none came.
  [[nodiscard]] bool gets(const std::function<bool(const LoggedLayers&)>& condition) const;

 private:
  static constexpr std::size_t kMost = 400;  // 20 s of two lidars at 10 Hz
  struct Pages {
    std::atomic<std::size_t> count;
    LoggedLayers layers[kMost];
  };

  void write();

  Pages* pages_;
  ipc::test::Step up_step_;
  ipc::test::Child child_;
  bool up_ = false;
};

}  // namespace gvom::test
