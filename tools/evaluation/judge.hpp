// All judges of one drive together.
#pragma once

#include <vector>

#include "tools/evaluation/ground_judge.hpp"
#include "tools/evaluation/object_judge.hpp"
#include "tools/evaluation/walker_judge.hpp"

namespace gvom::evaluation {

/// Of the lidar, for what the geometry allows.
struct SensorGeometry {
  double height_m;          ///< Above the ground that the vehicle stands on.
  double beam_spacing_rad;  ///< Between neighbouring beams, in elevation.
};

class Judge {
 public:
  /// `facts` must outlive this. `sight` is asked of what is solid and does not move.
  Judge(const SceneFacts& facts, const SensorGeometry& sensor, Sight sight);

  /// Frames in order of time.
  void add(const Frame& frame);
  [[nodiscard]] Figures result() const;

 private:
  void judge_holes(const Frame& frame);
  void fill_holes(Figures& figures) const;

  const SceneFacts& facts_;
  SensorGeometry sensor_;
  Sight sight_;
  GroundJudge ground_;
  PathJudge path_;
  ObjectJudge objects_;
  WalkerJudge walkers_;
  std::vector<std::vector<Approach>> approaches_;  // for each hole
};

}  // namespace gvom::evaluation
