// Ground: what is falsely lethal, how far its height is off, how much of it is known.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/evaluation/figures.hpp"
#include "tools/evaluation/scene_facts.hpp"
#include "tools/evaluation/tally.hpp"

namespace gvom::evaluation {

class GroundJudge {
 public:
  /// `facts` must outlive this.
  explicit GroundJudge(const SceneFacts& facts) : facts_(facts) {}

  /// Of some frames only the coverage of what is in sight is judged: it is what judging costs.
  void add(const Frame& frame, const Sight& sight);
  void fill(Figures& figures) const;

 private:
  struct HeightErrors {
    Spread bare_near, bare, vegetation, all;
  };
  struct Column {
    std::size_t truth;
    double ahead_m;
    std::uint8_t flags;
    std::uint8_t visibility;
    float height;
  };

  void judge_drivable(const Frame& frame, const Sight& sight, const Column& column);
  void judge_height(const Column& column);
  void judge_coverage_in_sight(const Frame& frame, const Sight& sight, const Column& column);

  const SceneFacts& facts_;
  ShareByRange negative_, hard_, steep_, lethal_;
  Share lethal_found_, grass_soft_, grass_hard_;
  Share coverage_near_, coverage_far_, sight_near_, sight_far_;
  HeightErrors errors_;
  int frames_ = 0;
};

/// Frames in which something lethal that is drivable in truth lies on the 2 m wide way ahead.
class PathJudge {
 public:
  explicit PathJudge(const SceneFacts& facts) : facts_(facts) {}
  void add(const Frame& frame);
  void fill(Figures& figures) const;

 private:
  const SceneFacts& facts_;
  Share barred_near_, barred_far_;
};

/// Whether a walker is so near the column now that it is not judged as ground.
bool holds_walker(const SceneFacts& facts, const Frame& frame, const Eigen::Vector2d& middle_m);

}  // namespace gvom::evaluation
