#include "tools/drive/live/lidar_stream.hpp"

#include <utility>
#include <vector>

#include "tools/sim/pcap_record.hpp"

namespace gvom::driving {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{1};

sim::SweepOptions noise_of(std::uint64_t seed) {
  sim::SweepOptions options;
  options.seed = seed;
  return options;
}

}  // namespace

LidarStream::LidarStream(const sim::World& world, const sim::Motion& motion, std::function<double()> known_s,
                         const sim::LidarModel& lidar, std::uint64_t seed, play::UdpSender sender,
                         Clock::time_point begin)
    : simulator_(world, motion, lidar, noise_of(seed)),
      known_s_(std::move(known_s)),
      sender_(std::move(sender)),
      begin_(begin),
      thread_([this] { live(); }) {}

LidarStream::~LidarStream() {
  ends_ = true;
  thread_.join();
}

void LidarStream::live() {
  const sim::LidarModel& lidar = simulator_.lidar();
  std::vector<std::uint8_t> record(sim::record_bytes(lidar));
  for (int sweep = 0;; ++sweep)
    for (int packet = 0; packet < sim::packets_of_sweep(lidar); ++packet) {
      const std::int64_t end_ns = sim::end_of_packet_ns(lidar, sweep, packet) - sim::kStartNs;
      std::this_thread::sleep_until(begin_ + std::chrono::nanoseconds(end_ns));
      if (!await_motion(1e-9 * static_cast<double>(end_ns))) return;
      send_packet(sweep, packet, record.data());
      if (Clock::now() > begin_ + std::chrono::nanoseconds(end_ns) + kLate) ++late_;
    }
}

bool LidarStream::await_motion(double time_s) const {
  while (!ends_ && known_s_() < time_s) std::this_thread::sleep_for(kLook);
  return !ends_;
}

void LidarStream::send_packet(int sweep, int packet, std::uint8_t* record) {
  if (!sends_) return;
  const sim::LidarModel& lidar = simulator_.lidar();
  sim::write_packet(simulator_, sweep, packet, record);
  const std::size_t bytes = sim::record_bytes(lidar) - sim::kPcapOverhead;
  const bool sent =
      sender_.send(record + sim::kPcapOverhead, bytes, static_cast<std::uint16_t>(lidar.udp_port));
  ++(sent ? sent_ : failed_);
}

}  // namespace gvom::driving
