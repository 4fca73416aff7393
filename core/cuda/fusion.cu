#include "core/cuda/fusion.hpp"

#include <algorithm>

namespace gvom::cuda {

namespace {

// Moments of a tick.
enum Moment { kSend, kFuse, kFused, kMake, kDeliver, kDelivered };

std::size_t most_in_window(const FusionSetup& setup) {
  return static_cast<std::size_t>(setup.lidars) * static_cast<std::size_t>(setup.config.window.buffer_size);
}

// A voxel of the fused map has a record if any map of the window has one there.
std::size_t most_voxel_records(const FusionSetup& setup) {
  const std::size_t voxels =
      std::size_t{grid_around(setup.config.map, Eigen::Vector3d::Zero()).brick_slots()} * kBrickCells;
  return std::min(voxels, most_in_window(setup) * setup.max_returns);
}

}  // namespace

Fusion::Fusion(std::unique_ptr<Device> device, const FusionSetup& setup, bool in_place)
    : device_(std::move(device)),
      in_place_(in_place),
      window_(setup.config.window, grid_around(setup.config.map, Eigen::Vector3d::Zero())),
      // A full window, the map that comes, and one that is refused.
      ring_(*device_, setup.config.map, most_in_window(setup) + 2, setup.max_returns, in_place),
      map_(*device_, setup.config, 2 * most_in_window(setup) + 2),
      layer_maker_(*device_, setup.config),
      voxel_writer_(*device_, setup.config.map, most_voxel_records(setup)) {
  unsettled_.reserve(most_in_window(setup) + 2);
}

// From here on the device reads no memory of the host.
DeviceExpected<void> Fusion::settle() {
  unsettled_.clear();
  map_.settled();
  return device_->wait();
}

DeviceExpected<AddResult> Fusion::add(const WindowMap& map) {
  if (device_->failed()) return tl::make_unexpected(device_->failure());
  if (unsettled_.size() == unsettled_.capacity()) static_cast<void>(settle());
  const std::uint64_t launches = device_->launches();
  WindowMap placed = map;
  placed.place = ring_.take();
  const AddResult result = window_.add(placed);
  if (result != AddResult::added) {
    ring_.give_back(placed.place);
    return result;
  }
  device_->mark(kSend);
  ring_.send(map.view, placed.place);
  unsettled_.push_back(placed.place);
  device_->mark(kFuse);
  map_.update(window_, placed.place, ring_);
  device_->mark(kFused);
  bool still_read = false;  // what has left and goes back to its owner now
  for (const WindowMap& left : window_.left()) {
    ring_.give_back(left.place);
    still_read |= in_place_ || std::count(unsettled_.begin(), unsettled_.end(), left.place) > 0;
  }
  if (still_read) static_cast<void>(settle());
  add_launches_ = device_->launches() - launches;
  if (device_->failed()) return tl::make_unexpected(device_->failure());
  return result;
}

DeviceExpected<void> Fusion::make_layers(const LayerArrays& out) {
  const std::uint64_t launches = device_->launches();
  device_->mark(kMake);
  layer_maker_.make(map_.view(), map_.window(), newest_moment(window_), out);
  device_->mark(kDeliver);
  layer_maker_.deliver(out);
  device_->mark(kDelivered);
  layer_launches_ = device_->launches() - launches;
  return settle();
}

DeviceExpected<BrickMapShape> Fusion::count_voxels() {
  voxel_writer_.measure(map_.bricks(), newest_moment(window_).grid);
  if (const auto done = settle(); !done) return tl::make_unexpected(done.error());
  return voxel_writer_.shape();
}

DeviceExpected<void> Fusion::write_voxels(const BrickMapArrays& out) {
  map_.copy_lowest_rays(newest_moment(window_).grid, voxel_writer_.lowest_ray_m());
  voxel_writer_.write(out);
  return settle();
}

void Fusion::reset() {
  static_cast<void>(settle());
  window_.clear();
  for (const WindowMap& left : window_.left()) ring_.give_back(left.place);
  map_.clear();
}

std::optional<DeviceCosts> Fusion::last_costs() const {
  return DeviceCosts{device_->ms_between(kSend, kFuse),    device_->ms_between(kFuse, kFused),
                     device_->ms_between(kMake, kDeliver), device_->ms_between(kDeliver, kDelivered),
                     add_launches_ + layer_launches_,      ring_.bytes_sent(),
                     layer_maker_.bytes_delivered()};
}

}  // namespace gvom::cuda
