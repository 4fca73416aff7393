#include "core/window.hpp"

#include <algorithm>
#include <cmath>

namespace gvom {

namespace {

bool goes_before(const WindowMap& a, const WindowMap& b) {
  if (a.view.stamp_ns != b.view.stamp_ns) return a.view.stamp_ns > b.view.stamp_ns;
  return a.lidar < b.lidar;
}

}  // namespace

Window::Window(const WindowConfig& config, const Grid& shape)
    : shape_(shape), buffer_size_(config.buffer_size), max_age_ns_(std::llround(config.max_age_s * 1e9)) {
  const auto most = static_cast<std::size_t>(kMaxLidars) * static_cast<std::size_t>(buffer_size_) + 1;
  maps_.reserve(most);
  left_.reserve(most);
}

AddResult Window::judge(const WindowMap& map) const {
  if (!map.view.grid.same_shape(shape_)) return AddResult::wrong_grid;
  if (!maps_.empty() && map.view.stamp_ns < maps_.front().view.stamp_ns - max_age_ns_)
    return AddResult::too_old;
  std::int64_t oldest_of_lidar = map.view.stamp_ns;
  for (const WindowMap& other : maps_) {
    if (other.lidar != map.lidar) continue;
    if (other.view.stamp_ns == map.view.stamp_ns) return AddResult::duplicate;
    oldest_of_lidar = other.view.stamp_ns;
  }
  const bool full = count(map.lidar) == buffer_size_;
  return full && map.view.stamp_ns < oldest_of_lidar ? AddResult::too_old : AddResult::added;
}

void Window::take_out(std::size_t index) {
  left_.push_back(maps_[index]);
  --counts_[static_cast<std::size_t>(maps_[index].lidar)];
  maps_.erase(maps_.begin() + static_cast<std::ptrdiff_t>(index));
}

AddResult Window::add(const WindowMap& map) {
  left_.clear();
  const AddResult result = judge(map);
  if (result != AddResult::added) return result;
  maps_.insert(std::upper_bound(maps_.begin(), maps_.end(), map, goes_before), map);
  ++counts_[static_cast<std::size_t>(map.lidar)];
  const std::int64_t oldest_ns = maps_.front().view.stamp_ns - max_age_ns_;
  for (std::size_t i = maps_.size(); i-- > 0;) {
    const WindowMap& old = maps_[i];
    const bool displaced = old.lidar == map.lidar && count(map.lidar) > buffer_size_;
    if (displaced || old.view.stamp_ns < oldest_ns) take_out(i);
  }
  return AddResult::added;
}

void Window::clear() {
  left_.assign(maps_.begin(), maps_.end());
  maps_.clear();
  counts_ = {};
}

}  // namespace gvom
