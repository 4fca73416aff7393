#include "services/common/odometry_tf.hpp"

#include <algorithm>

namespace gvom::services {
namespace {

constexpr std::size_t kMostLinks = 10'000;
constexpr std::size_t kMostWords = 20;

PoseResult pose_of(const ros::TransformIn& transform) {
  const auto& p = transform.translation_m;
  const auto& q = transform.rotation_xyzw;
  return make_pose(transform.header.stamp_ns, {p[0], p[1], p[2]}, {q[3], q[0], q[1], q[2]});
}

/// T_a_c of T_a_b and T_b_c.
Pose operator*(const Pose& a, const Pose& b) {
  return {a.translation_m + a.rotation * b.translation_m, (a.rotation * b.rotation).normalized()};
}

bool differs(const Pose& a, const Pose& b) {
  return a.translation_m != b.translation_m || a.rotation.coeffs() != b.rotation.coeffs();
}

}  // namespace

PoseResult TfChain::pose_by(const ros::TransformIn& transform) const {
  auto pose = pose_of(transform);
  if (pose) pose->T_odom_base = before_ * pose->T_odom_base * behind_;
  return pose;
}

tl::expected<Frames, std::string> parse_frames(const std::string& text) {
  const std::size_t slash = text.rfind('/');
  if (slash == std::string::npos || slash == 0 || slash + 1 == text.size())
    return tl::unexpected("tf='" + text + "': expected PARENT/CHILD");
  return Frames{text.substr(0, slash), text.substr(slash + 1)};
}

TfLinks::Seen* TfLinks::seen_of(const ros::TransformIn& transform) {
  const Frames link{std::string(transform.header.frame_id), std::string(transform.child_frame_id)};
  if (links_.size() >= kMostLinks && links_.count(link) == 0) return nullptr;
  return &links_[link];
}

void TfLinks::see(const ros::TransformIn& transform) {
  Seen* const seen = seen_of(transform);
  const auto pose = pose_of(transform);
  if (seen == nullptr || !pose) return;
  if (!seen->is_pose) seen->first = pose->T_odom_base;
  seen->is_pose = true;
  seen->moves = seen->moves || differs(seen->first, pose->T_odom_base);
}

bool TfLinks::see_standing(const ros::TransformIn& transform) {
  Seen* const seen = seen_of(transform);
  const auto pose = pose_of(transform);
  if (seen == nullptr || seen->moves || !pose) return false;
  const bool is_news = !seen->is_pose || differs(seen->first, pose->T_odom_base);
  *seen = {pose->T_odom_base, true, false};
  return is_news;
}

bool TfLinks::see_moving(const ros::TransformIn& transform) {
  Seen* const seen = seen_of(transform);
  if (seen == nullptr) return false;
  const bool is_news = !seen->moves;
  seen->is_pose = seen->moves = true;
  return is_news;
}

/// Links from `parent` to `child`, by a search from the child upwards; empty if there are none.
std::vector<Frames> TfLinks::way(const std::string& parent, const std::string& child) const {
  std::map<std::string, Frames> link_below;  // of each frame that was reached
  std::vector<std::string> reached{child};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const auto& [link, seen] : links_) {
      if (link.second != reached[i] || link.first == child || !seen.is_pose) continue;
      if (link_below.emplace(link.first, link).second) reached.push_back(link.first);
    }
  }
  std::vector<Frames> out;
  for (std::string at = parent; at != child;) {
    const auto below = link_below.find(at);
    if (below == link_below.end()) return {};
    out.push_back(below->second);
    at = below->second.second;
  }
  return out;
}

std::string TfLinks::text() const {
  std::string text;
  std::size_t words = 0;
  for (const auto& [link, seen] : links_) {
    if (++words > kMostWords) return text + ", ...";
    text += (text.empty() ? "" : ", ") + link.first + "/" + link.second;
  }
  return text.empty() ? "none" : text;
}

tl::expected<TfChain, std::string> TfLinks::chain(const std::string& parent, const std::string& child) const {
  const std::string name = parent + "/" + child;
  const auto links = way(parent, child);
  if (links.empty())
    return tl::unexpected("no way from " + parent + " to " + child + "; its links: " + text());
  auto moving = links.end();
  for (auto link = links.begin(); link != links.end(); ++link) {
    if (!links_.at(*link).moves) continue;
    if (moving != links.end())
      return tl::unexpected("of " + name + " two links move, " + moving->first + "/" + moving->second +
                            " and " + link->first + "/" + link->second + ": name one of them");
    moving = link;
  }
  const bool moves = moving != links.end();
  if (!moves) moving = links.begin();
  Pose before;
  Pose behind;
  for (auto link = links.begin(); link != links.end(); ++link) {
    if (link < moving) before = before * links_.at(*link).first;
    if (link > moving) behind = behind * links_.at(*link).first;
  }
  return TfChain(*moving, moves, before, behind);
}

}  // namespace gvom::services
