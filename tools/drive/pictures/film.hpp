// A drive in a few frames: what the planner saw and meant at each.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "core/format/grid.hpp"
#include "services/planner/planner.hpp"
#include "tools/drive/loop.hpp"

namespace gvom::driving {

/// Plain copies. Arrays are of the grid's columns, [y][x] from its origin.
struct Frame {
  std::int64_t stamp_ns = 0;  ///< Of the state.
  double time_s = 0;          ///< Since the first plan.
  planner::Pose2 place;       ///< By the odometry, as all places here.
  double speed_mps = 0;
  Grid grid;
  std::vector<float> height, slope_x, slope_y;
  std::vector<std::uint8_t> flags, visibility;
  std::vector<Eigen::Vector2d> path, trajectory;
  std::string why;
  std::size_t driven = 0;  ///< So many places of the film's way were driven by then.
};

/// Keeps frames in bounded memory: evenly spaced ones of the whole drive, and the newest of its last seconds.
class Film {
 public:
  static constexpr std::size_t kMostFrames = 24;  ///< Of the whole drive.
  static constexpr std::size_t kLastFrames = 4;   ///< Of the end,
  static constexpr double kBetweenLast_s = 1.0;   ///< so far apart.

  void add(const Seen& seen, const planner::Plan& plan);

  [[nodiscard]] bool empty() const { return frames_.empty(); }
  /// At most `count` of them in order of time, evenly spaced from the first to the last.
  [[nodiscard]] std::vector<const Frame*> pick(std::size_t count) const;
  /// The same, but half of them are of the last seconds.
  [[nodiscard]] std::vector<const Frame*> pick_end(std::size_t count) const;
  [[nodiscard]] const std::vector<Eigen::Vector2d>& way() const { return way_; }

 private:
  [[nodiscard]] Frame frame_of(const Seen& seen, const planner::Plan& plan) const;

  std::vector<Frame> frames_, last_;
  std::vector<Eigen::Vector2d> way_;
  std::int64_t first_ns_ = 0;
  double every_s_ = 0.5;
};

}  // namespace gvom::driving
