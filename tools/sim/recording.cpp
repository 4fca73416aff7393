#include "tools/sim/recording.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "tools/sim/packets.hpp"
#include "tools/sim/parallel.hpp"
#include "tools/sim/pcap_record.hpp"

namespace gvom::sim {
namespace {

constexpr int kBlockSweeps = 16;  // held in memory at a time
constexpr int kOdometryRate = 100;

tl::expected<void, std::string> write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) return tl::unexpected(path + ": cannot be written");
  return {};
}

tl::expected<void, std::string> write_pcap(const Scene& scene, const LidarModel& lidar,
                                           const std::string& path) {
  const SweepSimulator simulator(scene.world, scene.trajectory, lidar, scene.options.sweep);
  const std::size_t sweep_bytes = packets_of_sweep(lidar) * record_bytes(lidar);
  std::ofstream file(path, std::ios::binary);
  const auto write = [&](const std::vector<std::uint8_t>& bytes, std::size_t count) {
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(count));
  };
  const std::vector<std::uint8_t> header = pcap_file_header();
  write(header, header.size());
  std::vector<std::uint8_t> block(kBlockSweeps * sweep_bytes);
  for (int first = 0; first < scene.sweeps; first += kBlockSweeps) {
    const int count = std::min(kBlockSweeps, scene.sweeps - first);
    parallel_for(count, scene.options.threads,
                 [&](int i) { write_sweep(simulator, first + i, block.data() + i * sweep_bytes); });
    write(block, count * sweep_bytes);
  }
  file.close();
  if (!file) return tl::unexpected(path + ": cannot be written");
  return {};
}

std::string tum_text(const std::vector<StampedPose>& poses) {
  std::string text = "# t x y z qx qy qz qw  (T_odom_base; seconds, metres)\n";
  char line[256];
  for (const StampedPose& pose : poses) {
    const Eigen::Vector3d& p = pose.T_odom_base.translation_m;
    const Eigen::Quaterniond& q = pose.T_odom_base.rotation;
    std::snprintf(line, sizeof(line), "%lld.%09lld %.6f %.6f %.6f %.9f %.9f %.9f %.9f\n",
                  static_cast<long long>(pose.stamp_ns / 1'000'000'000),
                  static_cast<long long>(pose.stamp_ns % 1'000'000'000), p.x(), p.y(), p.z(), q.x(), q.y(),
                  q.z(), q.w());
    text += line;
  }
  return text;
}

}  // namespace

tl::expected<void, std::string> write_recording(const Scene& scene, const std::string& directory) {
  OdometrySpan span{kStartNs, scene.lidars.front().start_ns, kStartNs, kOdometryRate};
  for (const LidarModel& lidar : scene.lidars) {
    span.begin_ns = std::min(span.begin_ns, lidar.start_ns);
    span.end_ns = std::max(span.end_ns, lidar.stamp_ns(scene.sweeps - 1, lidar.columns - 1));
    const std::string stem = directory + "/" + lidar.name;
    auto written = write_pcap(scene, lidar, stem + ".pcap");
    if (written && lidar.sensor != Sensor::vlp_16)
      written = write_file(stem + ".json", ouster_metadata(lidar));
    if (!written) return written;
  }
  const auto poses =
      make_odometry(scene.trajectory, span, scene.options.odometry_noise, scene.options.sweep.seed);
  return write_file(directory + "/odometry.tum", tum_text(poses));
}

}  // namespace gvom::sim
