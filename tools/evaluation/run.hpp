// All scenes with all sensors on all drives.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/evaluation/drive.hpp"
#include "tools/evaluation/figures.hpp"

namespace gvom::evaluation {

/// How a scene is driven through.
struct DriveKind {
  std::string name;
  double speed_mps;
  sim::OdometryNoise odometry_noise;
  std::vector<sim::Sensor> sensors;
};

struct Plan {
  std::vector<std::string> scenes;
  std::vector<DriveKind> drives;
  mapping::Vehicle vehicle;
  std::uint64_t seed = 1;
  int frames = 40;
  int threads = 2;                   ///< Scenes at a time; they do not change a figure.
  std::string cache_directory;       ///< Empty: none.
  std::string pictures_directory;    ///< Empty: none.
  std::string recordings_directory;  ///< Empty: none.
};

/// Called when a scene is done; from one thread at a time.
using Progress = std::function<void(int done, int of, const std::string& scene, double took_s)>;

/// Rows in the plan's order. The first error, in that order.
tl::expected<std::vector<Row>, std::string> run(const Plan& plan, const Progress& progress);

}  // namespace gvom::evaluation
