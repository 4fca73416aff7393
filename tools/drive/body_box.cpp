#include "tools/drive/body_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gvom::driving {
namespace {

constexpr double kLine_m = 0.05;

int pieces(double length_m) {
  return std::max(1, static_cast<int>(std::ceil(length_m / kLine_m)));
}

}  // namespace

BodyBox::BodyBox(const VehicleModel& model, const Pose& T_odom_base)
    : T_odom_base_(Eigen::Translation3d(T_odom_base.translation_m) * T_odom_base.rotation),
      from_m_(-model.limits.rear_m, -0.5 * model.limits.width_m,
              model.limits.ground_clearance_m - model.base_height_m),
      to_m_(model.limits.front_m, 0.5 * model.limits.width_m, model.limits.height_m - model.base_height_m) {
  lower_.setConstant(std::numeric_limits<double>::infinity());
  upper_ = -lower_;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d at(((corner & 1) != 0 ? to_m_ : from_m_).x(),
                             ((corner & 2) != 0 ? to_m_ : from_m_).y(),
                             ((corner & 4) != 0 ? to_m_ : from_m_).z());
    lower_ = lower_.cwiseMin(T_odom_base_ * at);
    upper_ = upper_.cwiseMax(T_odom_base_ * at);
  }
}

bool BodyBox::meets(const sim::Primitive& body) const {
  if ((body.lower.array() > upper_.array()).any() || (body.upper.array() < lower_.array()).any())
    return false;
  const Eigen::Vector3d size = to_m_ - from_m_;
  const Eigen::Vector3d forward = T_odom_base_.linear().col(0);
  const int across = pieces(size.y()), high = pieces(size.z());
  for (int i = 0; i <= across; ++i)
    for (int k = 0; k <= high; ++k) {
      const Eigen::Vector3d begin = from_m_ + Eigen::Vector3d(0, size.y() * i / across, size.z() * k / high);
      const sim::Interval inside = intersect(body, {T_odom_base_ * begin, forward});
      if (!inside.empty() && inside.leave >= 0 && inside.enter <= size.x()) return true;
    }
  return false;
}

}  // namespace gvom::driving
