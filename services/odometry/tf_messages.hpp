// Poses out of the messages of /tf and /tf_static, as they come.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/odometry_tf.hpp"

namespace gvom::odometry {

/// T_parent_child. What comes on /tf moves, what comes on /tf_static stands as its newest message says; of
/// the links between the two frames just one may move. The pose has the stamp of that one.
class TfMessages {
 public:
  explicit TfMessages(services::Frames frames) : frames_(std::move(frames)) {}

  /// Of /tf_static. Errors: the message is not what its type says.
  tl::expected<void, std::string> stand(ros::Bytes message);

  /// Of /tf: the poses in it; none if it is of other links, or as long as `missing` says why. Errors: as
  /// above; the transform that moves is none (NaN, no rotation): the poses before it in the message are lost,
  /// too.
  tl::expected<std::vector<StampedPose>, std::string> read(ros::Bytes message);

  /// "base_link in odom, by odom/base_footprint"; empty as long as there is no way between the frames.
  [[nodiscard]] std::string frames() const;

  /// Why there is no pose: which links are missing, or that two move. Empty if nothing is missing.
  [[nodiscard]] const std::string& missing() const { return missing_; }

 private:
  void tie();

  services::Frames frames_;
  services::TfLinks links_;
  std::optional<services::TfChain> chain_;
  std::string missing_ = "no transform came yet";
  std::vector<ros::TransformIn> transforms_;
};

}  // namespace gvom::odometry
