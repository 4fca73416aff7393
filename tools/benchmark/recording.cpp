#include "tools/benchmark/recording.hpp"

#include <cstdio>

#include "core/odometry_buffer.hpp"
#include "services/common/odometry_file.hpp"
#include "services/ingest/source.hpp"

namespace gvom::bench {

namespace {

tl::expected<std::vector<Sweep>, std::string> read_sweeps(const std::string& folder) {
  const auto source = ingest::open_source("scans:" + folder, {});
  if (!source) return tl::unexpected(source.error().what);
  std::vector<Sweep> sweeps;
  for (;;) {
    Sweep sweep;
    const auto event = (*source)->next(sweep, std::chrono::milliseconds(0));
    if (!event) return tl::unexpected(event.error());
    if (*event == ingest::SourceEvent::kEnd) return sweeps;
    sweeps.push_back(std::move(sweep));
  }
}

// With one step more than there are between the sweeps.
Eigen::Vector3d way_of_a_lap(const std::vector<Pose>& poses) {
  if (poses.size() < 2) return Eigen::Vector3d::Zero();
  const auto count = static_cast<double>(poses.size());
  return (poses.back().translation_m - poses.front().translation_m) * (count / (count - 1));
}

}  // namespace

tl::expected<Recording, std::string> read_recording(const std::string& folder, const std::string& odometry,
                                                    double sensor_height_m) {
  auto sweeps = read_sweeps(folder);
  if (!sweeps) return tl::unexpected(sweeps.error());
  std::vector<std::string> warnings;
  const auto poses = services::read_odometry_source("tum:" + odometry, warnings);
  if (!poses) return tl::unexpected(poses.error());
  for (const std::string& warning : warnings) std::fprintf(stderr, "%s\n", warning.c_str());
  OdometryBuffer buffer(poses->size());
  for (const StampedPose& pose : *poses) buffer.add(pose);

  Recording recording;
  recording.name = folder;
  recording.lidar.T_base_sensor.translation().z() = sensor_height_m;
  for (Sweep& sweep : *sweeps) {
    const auto pose = buffer.at(sweep.stamp_ns);
    if (!pose) return tl::unexpected(odometry + ": no pose around a sweep of " + folder);
    recording.T_odom_base.push_back(*pose);
  }
  recording.lap_m = way_of_a_lap(recording.T_odom_base);
  recording.sweeps = std::move(*sweeps);
  return recording;
}

}  // namespace gvom::bench
