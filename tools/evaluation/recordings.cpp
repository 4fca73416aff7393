#include "tools/evaluation/recordings.hpp"

#include <chrono>
#include <filesystem>
#include <utility>

#include <yaml-cpp/yaml.h>

#include "core/odometry_buffer.hpp"
#include "services/common/config_file.hpp"
#include "services/common/odometry_file.hpp"
#include "services/ingest/source.hpp"
#include "services/ingest/source_options.hpp"
#include "tools/evaluation/known_way.hpp"

namespace gvom::evaluation {
namespace {

constexpr double kWarthogOs1Height_m = 1.4;  // RELLIS: of the OS1 above the ground around it
constexpr double kWayHalfWidth_m = 2.0;

using Recordings = tl::expected<std::vector<Recording>, std::string>;

services::LidarConfig make_lidar(const std::string& name, const std::string& source,
                                 const Eigen::Isometry3d& T_base_sensor) {
  services::LidarConfig lidar;
  lidar.name = name;
  lidar.source = source;
  lidar.geometry.T_base_sensor = T_base_sensor;
  return lidar;
}

services::VehicleConfig make_vehicle(const MapperConfig& mapper, double base_height_m,
                                     std::vector<services::LidarConfig> lidars) {
  services::VehicleConfig vehicle;
  vehicle.mapper = mapper;
  vehicle.mapper.vehicle = {};
  vehicle.mapper.vehicle.base_height_m = base_height_m;
  vehicle.lidars = std::move(lidars);
  return vehicle;
}

/// The vehicle of a file with one lidar.
tl::expected<services::VehicleConfig, std::string> read_vehicle(const std::string& name,
                                                                const MapperConfig& mapper,
                                                                const std::string& source) {
  auto vehicle = services::load_vehicle_config(GVOM_SOURCE_DIR "/config/vehicles/" + name + ".yaml");
  if (!vehicle) return tl::unexpected(vehicle.error().text());
  const VehicleGeometry geometry = vehicle->mapper.vehicle;
  vehicle->mapper = mapper;
  vehicle->mapper.vehicle = geometry;
  vehicle->lidars.front().source = source;
  return *vehicle;
}

/// RELLIS-3D: what is a vector in the VLP-32C's frame becomes one in the OS1's.
tl::expected<Eigen::Isometry3d, std::string> read_extrinsic(const std::string& path) {
  try {
    const YAML::Node node = YAML::LoadFile(path)["vel2os1"];
    const auto number = [&](const char* of, const char* axis) { return node[of][axis].as<double>(); };
    Eigen::Isometry3d T_os1_vlp = Eigen::Isometry3d::Identity();
    T_os1_vlp.translation() << number("t", "x"), number("t", "y"), number("t", "z");
    const Eigen::Quaterniond q(number("q", "w"), number("q", "x"), number("q", "y"), number("q", "z"));
    T_os1_vlp.linear() = q.normalized().toRotationMatrix();
    return T_os1_vlp;
  } catch (const YAML::Exception& error) {
    return tl::unexpected(path + ": " + error.what());
  }
}

/// One instant: base_link is the OS1's frame, and odom too.
Recordings find_rellis(const std::string& folder, const MapperConfig& mapper) {
  const auto T_os1_vlp = read_extrinsic(folder + "/vlp32_to_os1.yaml");
  if (!T_os1_vlp) return tl::unexpected(T_os1_vlp.error());
  const auto returns = read_labelled(folder + "/os1_64.bin", folder + "/os1_64.label");
  if (!returns) return tl::unexpected(returns.error());
  const KnownColumns known = know_by_labels(*returns, mapper.map.resolution_xy_m);
  const auto os1 = make_lidar("os1", "scans:" + folder + "/os1_64.bin", Eigen::Isometry3d::Identity());
  const auto vlp32 = make_lidar("vlp32", "scans:" + folder + "/vlp32.bin", *T_os1_vlp);
  std::vector<Recording> recordings;
  const auto add = [&](const char* sensor, std::vector<services::LidarConfig> lidars) {
    recordings.push_back(
        {"rellis", sensor, make_vehicle(mapper, kWarthogOs1Height_m, std::move(lidars)), "static", known});
  };
  add("both", {os1, vlp32});
  add("os1-64", {os1});
  add("vlp-32", {vlp32});
  return recordings;
}

/// All returns of a recording of one lidar, in odom; whole sweeps at the pose of their stamp.
tl::expected<std::vector<Eigen::Vector3d>, std::string> read_returns(const services::LidarConfig& lidar,
                                                                     const OdometryBuffer& odometry) {
  auto source = ingest::open_source(lidar.source, ingest::source_options(lidar));
  if (!source) return tl::unexpected(source.error().what);
  std::vector<Eigen::Vector3d> returns_m;
  for (Sweep sweep;;) {
    const auto event = (*source)->next(sweep, std::chrono::milliseconds(0));
    if (!event) return tl::unexpected(event.error());
    if (*event != ingest::SourceEvent::kSweep) return returns_m;
    const auto pose = odometry.at(sweep.stamp_ns);
    if (!pose) return tl::unexpected(lidar.source + ": the odometry does not cover it");
    const Eigen::Isometry3d T_odom_sensor =
        Eigen::Translation3d(pose->translation_m) * pose->rotation * lidar.geometry.T_base_sensor;
    for (const Return& r : sweep.returns)
      returns_m.emplace_back(T_odom_sensor * Eigen::Vector3d(r.x_m, r.y_m, r.z_m));
  }
}

/// Where the car went before and after can be driven.
Recordings find_kitti(const std::string& folder, const MapperConfig& mapper) {
  const std::string odometry = "tum:" + folder + "/odometry.tum";
  auto vehicle = read_vehicle("kitti", mapper, "scans:" + folder);
  if (!vehicle) return tl::unexpected(vehicle.error());
  std::vector<std::string> ignored;
  const auto poses = services::read_odometry_source(odometry, ignored);
  if (!poses) return tl::unexpected(poses.error());
  Way way_m;
  OdometryBuffer buffer(poses->size());
  for (const StampedPose& pose : *poses) {
    way_m.push_back(pose.T_odom_base.translation_m);
    buffer.add(pose);
  }
  const auto returns_m = read_returns(vehicle->lidars.front(), buffer);
  if (!returns_m) return tl::unexpected(returns_m.error());
  KnownColumns known = know_by_way(way_m, kWayHalfWidth_m, mapper.map.resolution_xy_m);
  forget_traffic(known, way_m, *returns_m);
  return std::vector<Recording>{{"kitti", "hdl-64", std::move(*vehicle), odometry, std::move(known)}};
}

Recordings find_woods(const std::string& folder, const MapperConfig& mapper) {
  constexpr double kBaseHeight_m = 0.068, kYaw_rad = 2.35619449;
  Eigen::Isometry3d T_base_sensor = Eigen::Isometry3d::Identity();
  T_base_sensor.translation() << 0.065, 0.0, 0.408;
  T_base_sensor.linear() = Eigen::AngleAxisd(kYaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  auto vehicle = make_vehicle(mapper, kBaseHeight_m,
                              {make_lidar("top", "scans:" + folder + "/marv_ouster.pcd", T_base_sensor)});
  return std::vector<Recording>{
      {"woods", "ouster", std::move(vehicle), "static", KnownColumns(mapper.map.resolution_xy_m)}};
}

Recordings find_car(const std::string& folder, const MapperConfig& mapper) {
  auto vehicle = read_vehicle("ouster_os1_128", mapper,
                              "ouster:" + folder + "/os1_128.pcap?meta=" + folder + "/os1_128.json");
  if (!vehicle) return tl::unexpected(vehicle.error());
  return std::vector<Recording>{{"car", "os1-128", std::move(*vehicle), "tum:" + folder + "/odometry.tum",
                                 KnownColumns(mapper.map.resolution_xy_m)}};
}

}  // namespace

tl::expected<FoundRecordings, std::string> find_recordings(const std::string& directory,
                                                           const MapperConfig& mapper) {
  constexpr std::pair<const char*, Recordings (*)(const std::string&, const MapperConfig&)> kFolders[] = {
      {"rellis_offroad", find_rellis},
      {"kitti_drive0005", find_kitti},
      {"forest", find_woods},
      {"ouster_os1_128_moving", find_car}};
  FoundRecordings found;
  for (const auto& [name, find] : kFolders) {
    const std::string folder = directory + "/" + name;
    if (!std::filesystem::is_directory(folder)) {
      found.missing.push_back(folder);
      continue;
    }
    auto recordings = find(folder, mapper);
    if (!recordings) return tl::unexpected(recordings.error());
    for (Recording& recording : *recordings) found.recordings.push_back(std::move(recording));
  }
  return found;
}

}  // namespace gvom::evaluation
