#include "tools/evaluation/drive.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gvom::evaluation {
namespace {

constexpr std::int64_t kOutOfStep_ns = 37'100'000;  // between the lidars' first columns
constexpr int kOdometry_hz = 100;
constexpr int kOuster_hz = 10;
constexpr double kBeforeRim_m = 3.0;  // as where a scene ends at a hole: nearer it leaves the window

std::vector<sim::LidarModel> make_lidars(const mapping::Vehicle& vehicle, const DriveOptions& options) {
  std::vector<sim::LidarModel> lidars;
  for (const LidarGeometry& geometry : vehicle.lidars) {
    const int number = static_cast<int>(lidars.size());
    const sim::LidarPlace place{"lidar", number, 0, sim::kStartNs + number * kOutOfStep_ns,
                                geometry.T_base_sensor};
    lidars.push_back(make_lidar(options.sensor, place, kOuster_hz, options.seed));
  }
  return lidars;
}

double seconds_of(std::int64_t stamp_ns) {
  return 1e-9 * static_cast<double>(stamp_ns - sim::kStartNs);
}

SweepSpan choose_span(const Stage& stage, const sim::LidarModel& lidar, int wanted) {
  const auto sweeps_until = [&](double time_s) {
    return static_cast<int>(time_s * 1e9 / static_cast<double>(lidar.turn_ns));
  };
  const int all = sweeps_until(stage.trajectory().seconds());
  SweepSpan span{0, std::min(all, wanted)};
  const std::vector<Hole>& holes = stage.facts().holes;
  if (!holes.empty()) {
    const double end_s = (holes.front().rim_driven_m - kBeforeRim_m) / stage.speed_mps();
    span.first = std::max(0, std::min(all, sweeps_until(end_s)) - span.count);
  }
  return span;
}

SensorGeometry geometry_of(const sim::LidarModel& lidar, double base_height_m) {
  const auto [low, high] = std::minmax_element(lidar.altitude_deg.begin(), lidar.altitude_deg.end());
  return {lidar.T_base_sensor.translation().z() + base_height_m,
          (*high - *low) / (lidar.beams() - 1) * M_PI / 180.0};
}

OdometryBuffer make_poses(const Stage& stage, const std::vector<sim::LidarModel>& lidars,
                          const SweepSpan& span, const DriveOptions& options) {
  const sim::OdometrySpan wanted{sim::kStartNs, lidars.front().stamp_ns(span.first, 0),
                                 lidars.back().stamp_ns(span.first + span.count, 0), kOdometry_hz};
  OdometryBuffer poses;
  for (const StampedPose& pose :
       make_odometry(stage.trajectory(), wanted, options.odometry_noise, options.seed))
    poses.add(pose);
  return poses;
}

Frame make_frame(const Stage& stage, const sim::LidarModel& lidar, std::int64_t stamp_ns,
                 mapping::Pipeline& pipeline) {
  Frame frame;
  frame.time_s = seconds_of(stamp_ns);
  frame.driven_m = frame.time_s * stage.speed_mps();
  const Pose base = stage.trajectory().at(frame.time_s);
  frame.base_m = base.translation_m.head<2>();
  frame.forward = (base.rotation * Eigen::Vector3d::UnitX()).head<2>().normalized();
  frame.sensor_m = base.translation_m + base.rotation * lidar.T_base_sensor.translation();
  const LayerArrays& layers = pipeline.make_layers();
  frame.origin = {pipeline.grid().origin[0], pipeline.grid().origin[1]};
  frame.size = pipeline.grid().size[0];
  frame.height = layers.height;
  frame.flags = layers.flags;
  frame.visibility = layers.visibility;
  return frame;
}

/// The sweeps of all lidars, in order of time.
class Recording {
 public:
  static tl::expected<Recording, std::string> open(const Stage& stage,
                                                   const std::vector<sim::LidarModel>& lidars,
                                                   const SweepSpan& span, const DriveOptions& options) {
    Recording recording;
    recording.simulators_.reserve(lidars.size());  // the caches point into it
    sim::SweepOptions measured;
    measured.seed = options.seed;
    for (const sim::LidarModel& lidar : lidars) {
      recording.simulators_.emplace_back(stage.world(), stage.trajectory(), lidar, measured);
      auto cache =
          SweepCache::open(recording.simulators_.back(), span, stage.world_key(), options.cache_directory);
      if (!cache) return tl::unexpected(cache.error());
      recording.caches_.push_back(std::move(*cache));
    }
    return recording;
  }

  tl::expected<void, std::string> next(std::size_t lidar, Sweep& out) { return caches_[lidar].next(out); }

 private:
  std::vector<sim::SweepSimulator> simulators_;
  std::vector<SweepCache> caches_;
};

}  // namespace

tl::expected<Figures, std::string> drive(const Stage& stage, const mapping::Vehicle& vehicle,
                                         const DriveOptions& options, const Watch& watch) {
  const std::vector<sim::LidarModel> lidars = make_lidars(vehicle, options);
  const int warm_up = vehicle.mapper.window.buffer_size;
  const SweepSpan span = choose_span(stage, lidars.front(), warm_up + options.frames);
  const OdometryBuffer poses = make_poses(stage, lidars, span, options);
  auto recording = Recording::open(stage, lidars, span, options);
  if (!recording) return tl::unexpected(recording.error());
  mapping::Pipeline pipeline(vehicle,
                             static_cast<std::size_t>(lidars.front().beams()) * lidars.front().columns);
  Judge judge(stage.facts(), geometry_of(lidars.front(), vehicle.mapper.vehicle.base_height_m),
              stage.sight());
  const int every = stage.facts().holes.empty() && stage.facts().walkers.empty() ? 2 : 1;
  Sweep sweep;
  for (int i = 0; i < span.count; ++i) {
    for (std::size_t lidar = 0; lidar < lidars.size(); ++lidar) {
      const auto mapped =
          recording->next(lidar, sweep).and_then([&] { return pipeline.add(lidar, sweep, poses); });
      if (!mapped) return tl::unexpected(mapped.error());
    }
    if (i < warm_up - 1 || (span.count - 1 - i) % every != 0) continue;
    const Frame frame = make_frame(stage, lidars.front(), sweep.stamp_ns, pipeline);
    judge.add(frame);
    if (watch) watch(frame);
  }
  return judge.result();
}

}  // namespace gvom::evaluation
