#include "tools/sim/recording.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/sim/noise.hpp"
#include "tools/sim/parallel.hpp"

namespace gvom::sim {
namespace {

constexpr double kMaxRange = 100.0;
constexpr double kMinRange = 0.3;
constexpr double kTurn = 6.283185307179586;
constexpr double kDegree = kTurn / 360.0;
constexpr int kBlockSweeps = 16;  // held in memory at a time
constexpr int kOdometryRate = 100;

// Streams of a ray's key beside those of the bodies, which are numbered from 0.
constexpr std::uint64_t kRangeStream = 1ULL << 32;
constexpr std::uint64_t kShadeStream = kRangeStream + 1;

/// Directions of the beams in the lidar's frame when it points along +x.
std::vector<Eigen::Vector3d> beam_directions(const LidarModel& lidar) {
  std::vector<Eigen::Vector3d> directions;
  for (int beam = 0; beam < kBeams; ++beam) {
    const double altitude = lidar.altitude_deg[beam] * kDegree;
    const double azimuth = -lidar.azimuth_deg[beam] * kDegree;
    directions.emplace_back(std::cos(altitude) * std::cos(azimuth), std::cos(altitude) * std::sin(azimuth),
                            std::sin(altitude));
  }
  return directions;
}

/// What a beam reports: the range counts from the lidar's axis, so the way to the beam's origin is in it.
Pixel measure(const Hit& hit, double range_noise_m, std::uint64_t key) {
  if (hit.range_m > kMaxRange) return {};
  const double range = hit.range_m + kBeamOrigin + range_noise_m * normal(derive(key, kRangeStream));
  if (range < kMinRange) return {};
  const std::uint64_t shade = derive(key, kShadeStream);
  return {static_cast<std::uint16_t>(std::lround(range / kRangeUnit)),
          static_cast<std::uint8_t>(hit.reflectivity + shade % 8),
          static_cast<std::uint8_t>(20 + (shade >> 8) % 16)};
}

tl::expected<void, std::string> write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) return tl::unexpected(path + ": cannot be written");
  return {};
}

tl::expected<void, std::string> write_pcap(const Scene& scene, const LidarModel& lidar,
                                           const std::string& path) {
  constexpr std::size_t kSweepBytes = kPackets * kRecordBytes;
  std::ofstream file(path, std::ios::binary);
  const auto write = [&](const std::vector<std::uint8_t>& bytes, std::size_t count) {
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(count));
  };
  const std::vector<std::uint8_t> header = pcap_file_header();
  write(header, header.size());
  std::vector<std::uint8_t> block(kBlockSweeps * kSweepBytes);
  for (int first = 0; first < scene.options.sweeps(); first += kBlockSweeps) {
    const int count = std::min(kBlockSweeps, scene.options.sweeps() - first);
    parallel_for(count, scene.options.threads,
                 [&](int i) { simulate_sweep(scene, lidar, first + i, block.data() + i * kSweepBytes); });
    write(block, count * kSweepBytes);
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

void simulate_sweep(const Scene& scene, const LidarModel& lidar, int sweep, std::uint8_t* records) {
  const std::vector<Eigen::Vector3d> directions = beam_directions(lidar);
  const Eigen::Isometry3d T_base_lidar = lidar.T_base_sensor * lidar_to_sensor();
  const std::uint64_t sweep_key =
      derive(derive(derive(scene.options.seed, 0x5EE9), static_cast<std::uint64_t>(lidar.number)),
             static_cast<std::uint64_t>(sweep));
  for (int packet = 0; packet < kPackets; ++packet) {
    PacketRecord record(records + packet * kRecordBytes, lidar, sweep, packet);
    for (int index = 0; index < kColumnsPerPacket; ++index) {
      const int column = packet * kColumnsPerPacket + index;
      const std::int64_t stamp_ns = lidar.stamp_ns(sweep, column);
      const double time_s = 1e-9 * static_cast<double>(stamp_ns - kStartNs);
      const Pose base = scene.trajectory.at(time_s);
      const double turned = kTurn * (1.0 - static_cast<double>(column) / kColumns);
      const Eigen::Isometry3d T_odom_beams = Eigen::Translation3d(base.translation_m) * base.rotation *
                                             T_base_lidar *
                                             Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitZ());
      const Primitive person = scene.world.person_at(time_s);
      const Eigen::Vector3d origin = T_odom_beams * Eigen::Vector3d(kBeamOrigin, 0.0, 0.0);
      Pixel pixels[kBeams];
      for (int beam = 0; beam < kBeams; ++beam) {
        const std::uint64_t key = derive(sweep_key, static_cast<std::uint64_t>(column * kBeams + beam));
        const Ray ray{origin, T_odom_beams.linear() * directions[beam]};
        pixels[beam] =
            measure(scene.world.cast(ray, person, kMaxRange, key), scene.options.range_noise_m, key);
      }
      record.set_column(index, stamp_ns, pixels);
    }
  }
}

tl::expected<void, std::string> write_recording(const Scene& scene, const std::vector<LidarModel>& lidars,
                                                const std::string& directory) {
  OdometrySpan span{kStartNs, lidars.front().start_ns, kStartNs, kOdometryRate};
  for (const LidarModel& lidar : lidars) {
    span.begin_ns = std::min(span.begin_ns, lidar.start_ns);
    span.end_ns = std::max(span.end_ns, lidar.stamp_ns(scene.options.sweeps() - 1, kColumns - 1));
    const std::string stem = directory + "/" + lidar.name;
    const auto written = write_pcap(scene, lidar, stem + ".pcap").and_then([&] {
      return write_file(stem + ".json", metadata_json(lidar));
    });
    if (!written) return written;
  }
  const auto poses = make_odometry(scene.trajectory, span, scene.options.odometry_noise, scene.options.seed);
  return write_file(directory + "/odometry.tum", tum_text(poses));
}

}  // namespace gvom::sim
