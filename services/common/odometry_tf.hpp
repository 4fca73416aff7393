// The way between two frames of tf, of which one link moves.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/odometry_lines.hpp"
#include "services/common/ros/incoming.hpp"

namespace gvom::services {

/// T_parent_child by one moving transform and those that stand still before and behind it.
class TfChain {
 public:
  TfChain(std::pair<std::string, std::string> moving, Pose before, Pose behind)
      : moving_(std::move(moving)), before_(std::move(before)), behind_(std::move(behind)) {}

  /// Whether `transform` is of the link that moves.
  [[nodiscard]] bool is_moving(const ros::TransformIn& transform) const {
    return transform.header.frame_id == moving_.first && transform.child_frame_id == moving_.second;
  }
  /// At the transform's own stamp; an error if it is none.
  [[nodiscard]] PoseResult pose_by(const ros::TransformIn& transform) const;

 private:
  std::pair<std::string, std::string> moving_;  // parent, child
  Pose before_;
  Pose behind_;
};

/// Which frames tf ties together.
class TfLinks {
 public:
  void see(const ros::TransformIn& transform);

  /// The way from `parent` down to `child`. Errors: there is none (with the links that there are), nothing on
  /// it moves, more than one link moves.
  [[nodiscard]] tl::expected<TfChain, std::string> chain(const std::string& parent,
                                                         const std::string& child) const;

 private:
  using Link = std::pair<std::string, std::string>;  // parent, child
  struct Seen {
    Pose first;
    bool is_pose = false;
    bool moves = false;
  };

  [[nodiscard]] std::vector<Link> way(const std::string& parent, const std::string& child) const;
  [[nodiscard]] std::string text() const;

  std::map<Link, Seen> links_;
};

}  // namespace gvom::services
