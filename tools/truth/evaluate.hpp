// How well maps agree with what is really there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/truth/dataset.hpp"

namespace gvom::truth {

/// How many of how many.
struct Share {
  std::size_t hits = 0;
  std::size_t of = 0;

  void count(bool hit) {
    hits += hit;
    ++of;
  }
  /// NaN where nothing was counted.
  [[nodiscard]] double ratio() const;
};

struct ErrorSummary {
  std::size_t count = 0;
  double bias_m = 0.0;    ///< Mean of map - truth; NaN where nothing was counted, as below.
  double median_m = 0.0;  ///< Of the absolute error.
  double p95_m = 0.0;     ///< Of the absolute error.
};

/// *Near* is ahead of the vehicle and within `within_m` of it. A column or an object is flagged if it is in
/// any map in which it is near. Rates on plain ground and of the person count (map, column) and map.
struct Evaluation {
  std::size_t frames = 0;
  double within_m = 0.0;

  /// Height minus truth, where ground was seen (not ASSUMED) and the true class is ground.
  ErrorSummary height_lowest, height_mean;            ///< Everywhere.
  ErrorSummary near_height_lowest, near_height_mean;  ///< Near.

  Share trees_hard, tree_columns_hard;
  Share bushes_soft, bush_columns_soft, bushes_obstacle, bush_columns_obstacle;
  Share tall_rocks_hard, tall_rocks_obstacle, low_rocks_obstacle;  ///< Tall: 0.9 m and more.
  /// Of columns in which the ditch is at least 0.5 m deep. Bottom: a height within 0.3 m of the true one.
  Share ditch_negative, ditch_steep, ditch_hard, ditch_bottom_seen, ditch_lethal;
  Share step_columns_lethal;  ///< HARD, STEEP or NEGATIVE.

  /// Columns of class ground further than one column from any other class, observed and near; and observed
  /// anywhere.
  Share near_false_hard, near_false_soft, near_false_negative, near_false_steep;
  Share false_hard, false_soft, false_negative, false_steep;

  ErrorSummary
      branch_clearance;       ///< R14 against the truth, near columns under the branch with any clearance.
  Share branch_columns_seen;  ///< Columns that are under the branch and ever had a clearance.
  Share person_flagged;  ///< Maps in which a column within 0.6 m of where the person is now is an obstacle.
  Share person_left_behind;  ///< Columns of the person's way, 1.5 m and more from the person, that are
                             ///< obstacles.
};

/// Adds up one map after another.
class Evaluator {
 public:
  /// `truth` must outlive this.
  Evaluator(const Truth& truth, double within_m);

  /// `heading` is the direction in which the vehicle moves (any length; zero: everything is ahead).
  /// The frame's resolution must be the truth's.
  void add(const Frame& frame, const std::array<double, 2>& heading);

  [[nodiscard]] Evaluation result() const;

 private:
  struct Column;
  void judge_ground(const Column& column);
  void judge_person(const Frame& frame, const std::array<double, 2>& heading);
  void count_columns(Evaluation& out) const;
  void count_objects(Evaluation& out) const;

  const Truth& truth_;
  Evaluation sums_;
  std::vector<std::uint8_t> plain_;  // 1: ground far from anything else
  std::vector<std::uint8_t> ever_;   // per column of the truth, what was ever true while it was near
  std::vector<float> error_lowest_, error_mean_, near_error_lowest_, near_error_mean_, clearance_error_;
};

/// The vehicle's direction at each frame, from where it was some frames before to some frames after.
std::vector<std::array<double, 2>> headings(const std::vector<FrameInfo>& frames);

}  // namespace gvom::truth
