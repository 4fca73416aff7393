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

/// Of tf: parent and child.
using Frames = std::pair<std::string, std::string>;

/// PARENT/CHILD; the last '/' divides them.
tl::expected<Frames, std::string> parse_frames(const std::string& text);

/// T_parent_child by one moving transform and those that stand still before and behind it.
class TfChain {
 public:
  TfChain(Frames moving, bool moves, Pose before, Pose behind)
      : moving_(std::move(moving)), moves_(moves), before_(std::move(before)), behind_(std::move(behind)) {}

  /// Whether `transform` is of the link that moves.
  [[nodiscard]] bool is_moving(const ros::TransformIn& transform) const {
    return transform.header.frame_id == moving_.first && transform.child_frame_id == moving_.second;
  }
  /// False: all links stand, and the first is taken for the one that would move.
  [[nodiscard]] bool moves() const { return moves_; }
  [[nodiscard]] std::string moving() const { return moving_.first + "/" + moving_.second; }
  /// At the transform's own stamp; an error if it is none.
  [[nodiscard]] PoseResult pose_by(const ros::TransformIn& transform) const;

 private:
  Frames moving_;
  bool moves_;
  Pose before_;
  Pose behind_;
};

/// Which frames tf ties together.
class TfLinks {
 public:
  /// Of a recording: what differs from the first of its link moves.
  void see(const ros::TransformIn& transform);
  /// Of a link that stands still, as this says from now on; none that moves does. True: that is news.
  bool see_standing(const ros::TransformIn& transform);
  /// Of a link that moves, though it may stand now. True: that is news.
  bool see_moving(const ros::TransformIn& transform);

  /// The way from `parent` down to `child`. Errors: there is none (with the links that there are), nothing on
  /// it moves, more than one link moves.
  [[nodiscard]] tl::expected<TfChain, std::string> chain(const std::string& parent,
                                                         const std::string& child) const;

 private:
  struct Seen {
    Pose first;
    bool is_pose = false;
    bool moves = false;
  };

  /// That of `transform`; nothing if there are too many.
  Seen* seen_of(const ros::TransformIn& transform);
  [[nodiscard]] std::vector<Frames> way(const std::string& parent, const std::string& child) const;
  [[nodiscard]] std::string text() const;

  std::map<Frames, Seen> links_;
};

}  // namespace gvom::services
