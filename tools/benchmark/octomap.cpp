#include <octomap/OcTree.h>
#include <octomap/octomap.h>

#include "tools/benchmark/measure.hpp"

namespace gvom::bench {

namespace {

struct Scan {
  octomap::Pointcloud points;  // in odom
  octomap::point3d origin;
};

octomap::point3d to_octomap(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

std::vector<Scan> scans_of(const Recording& recording) {
  std::vector<Scan> scans;
  for (std::size_t i = 0; i < recording.sweeps.size(); ++i) {
    const Pose& pose = recording.T_odom_base[i];
    const Eigen::Isometry3d T_odom_sensor =
        Eigen::Translation3d(pose.translation_m) * pose.rotation * recording.lidar.T_base_sensor;
    Scan scan{{}, to_octomap(T_odom_sensor.translation())};
    for (const Return& r : recording.sweeps[i].returns) {
      const Eigen::Vector3d p(r.x_m, r.y_m, r.z_m);
      const double range_m = p.norm();
      if (range_m >= recording.lidar.min_range_m && range_m <= recording.lidar.max_range_m)
        scan.points.push_back(to_octomap(T_odom_sensor * p));
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

Samples insert_all(const std::vector<Scan>& scans, int repeats, double resolution_m, double max_range_m,
                   bool discretize) {
  octomap::OcTree tree(resolution_m);
  Samples samples;
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (const Scan& scan : scans)
      samples.add(
          time_ms([&] { tree.insertPointCloud(scan.points, scan.origin, max_range_m, false, discretize); }));
  return samples;
}

}  // namespace

OctomapTimes measure_octomap(const Recording& recording, int repeats) {
  const std::vector<Scan> scans = scans_of(recording);
  const double resolution_m = MapConfig().resolution_xy_m;
  const double max_range_m = recording.lidar.max_range_m;
  return {insert_all(scans, repeats, resolution_m, max_range_m, false),
          insert_all(scans, repeats, resolution_m, max_range_m, true)};
}

}  // namespace gvom::bench
