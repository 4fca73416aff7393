// A simulated lidar that measures and sends as a real one does: packet by packet, in real time.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <thread>

#include "tools/play/udp_sender.hpp"
#include "tools/sim/packets.hpp"

namespace gvom::driving {

struct StreamCounts {
  std::uint64_t sent = 0;
  std::uint64_t late = 0;    ///< More than `LidarStream::kLate` after they were due.
  std::uint64_t failed = 0;  ///< The system would not send them.
};

class LidarStream {
 public:
  static constexpr std::chrono::milliseconds kLate{20};

  /// Measures from now on, in a thread of its own. All references outlive it, and may be read by that thread.
  /// @param known_s up to which time of the drive the motion is known
  /// @param begin the drive's time 0
  LidarStream(const sim::World& world, const sim::Motion& motion, std::function<double()> known_s,
              const sim::LidarModel& lidar, std::uint64_t seed, play::UdpSender sender,
              std::chrono::steady_clock::time_point begin);
  ~LidarStream();
  LidarStream(const LidarStream&) = delete;
  LidarStream& operator=(const LidarStream&) = delete;

  /// Off: it turns, but nothing of it comes.
  void let_send(bool on) { sends_ = on; }
  [[nodiscard]] StreamCounts counts() const { return {sent_, late_, failed_}; }

 private:
  void live();
  /// False: it is to end.
  bool await_motion(double time_s) const;
  void send_packet(int sweep, int packet, std::uint8_t* record);

  sim::SweepSimulator simulator_;
  std::function<double()> known_s_;
  play::UdpSender sender_;
  std::chrono::steady_clock::time_point begin_;
  std::atomic<bool> sends_{true};
  std::atomic<bool> ends_{false};
  std::atomic<std::uint64_t> sent_{0}, late_{0}, failed_{0};
  std::thread thread_;
};

}  // namespace gvom::driving
