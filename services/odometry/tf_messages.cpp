#include "services/odometry/tf_messages.hpp"

namespace gvom::odometry {

tl::expected<void, std::string> TfMessages::stand(ros::Bytes message) {
  if (const auto read = ros::read_transforms(message, transforms_); !read)
    return tl::unexpected(read.error());
  bool is_news = false;
  for (const ros::TransformIn& transform : transforms_) is_news |= links_.see_standing(transform);
  if (is_news) tie();
  return {};
}

tl::expected<std::vector<StampedPose>, std::string> TfMessages::read(ros::Bytes message) {
  if (const auto read = ros::read_transforms(message, transforms_); !read)
    return tl::unexpected(read.error());
  bool is_news = false;
  for (const ros::TransformIn& transform : transforms_) is_news |= links_.see_moving(transform);
  if (is_news) tie();
  std::vector<StampedPose> poses;
  for (const ros::TransformIn& transform : transforms_) {
    if (!chain_ || !chain_->is_moving(transform)) continue;
    const auto pose = chain_->pose_by(transform);
    if (!pose) return tl::unexpected(chain_->moving() + ": " + pose.error());
    poses.push_back(*pose);
  }
  return poses;
}

std::string TfMessages::frames() const {
  return chain_ ? frames_.second + " in " + frames_.first + ", by " + chain_->moving() : "";
}

void TfMessages::tie() {
  chain_.reset();
  auto chain = links_.chain(frames_.first, frames_.second);
  missing_ = chain ? "" : chain.error();
  if (chain && !chain->moves())
    missing_ = "nothing between " + frames_.first + " and " + frames_.second + " moves";
  if (missing_.empty()) chain_ = std::move(*chain);
}

}  // namespace gvom::odometry
