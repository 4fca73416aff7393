#include "tools/sim/bin_grid.hpp"

#include <algorithm>

namespace gvom::sim {

BinGrid::BinGrid(const std::vector<Primitive>& bodies) {
  if (bodies.empty()) return;
  Eigen::Vector3d low = bodies.front().lower;
  Eigen::Vector3d high = bodies.front().upper;
  for (const Primitive& body : bodies) {
    low = low.cwiseMin(body.lower);
    high = high.cwiseMax(body.upper);
  }
  min_x_m_ = low.x();
  min_y_m_ = low.y();
  width_ = static_cast<int>((high.x() - low.x()) / kEdge) + 1;
  height_ = static_cast<int>((high.y() - low.y()) / kEdge) + 1;
  bins_.resize(static_cast<std::size_t>(width_) * height_);

  std::vector<std::vector<int>> lists(bins_.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Eigen::Vector3d from = (bodies[i].lower - low) / kEdge;
    const Eigen::Vector3d to = (bodies[i].upper - low) / kEdge;
    for (int iy = static_cast<int>(from.y()); iy <= static_cast<int>(to.y()); ++iy)
      for (int ix = static_cast<int>(from.x()); ix <= static_cast<int>(to.x()); ++ix) {
        const std::size_t at = static_cast<std::size_t>(iy) * width_ + ix;
        lists[at].push_back(static_cast<int>(i));
        bins_[at].top_m = std::max(bins_[at].top_m, bodies[i].upper.z());
      }
  }
  for (std::size_t at = 0; at < bins_.size(); ++at) {
    bins_[at].begin = members_.size();
    members_.insert(members_.end(), lists[at].begin(), lists[at].end());
    bins_[at].end = members_.size();
  }
}

}  // namespace gvom::sim
