#include "tools/mapping/pipeline.hpp"

#include <utility>

namespace gvom::mapping {

LayerStorage::LayerStorage(const MapConfig& map) {
  const std::size_t columns = static_cast<std::size_t>(map.size_xy) * map.size_xy;
  floats_.resize(columns * kFloatLayers);
  bytes_.resize(columns * (kLayers - kFloatLayers));
  float** const float_fields[] = {&arrays_.height,           &arrays_.inferred_height, &arrays_.slope_x,
                                  &arrays_.slope_y,          &arrays_.slope,           &arrays_.roughness,
                                  &arrays_.obstacle_density, &arrays_.negative_delta,  &arrays_.clearance,
                                  &arrays_.last_seen};
  std::uint8_t** const byte_fields[] = {&arrays_.flags, &arrays_.visibility, &arrays_.cost};
  float* next_float = floats_.data();
  for (float** field : float_fields) *field = std::exchange(next_float, next_float + columns);
  std::uint8_t* next_byte = bytes_.data();
  for (std::uint8_t** field : byte_fields) *field = std::exchange(next_byte, next_byte + columns);
}

Pipeline::Pipeline(const Vehicle& vehicle, std::size_t max_returns)
    : Pipeline(vehicle, max_returns, std::make_unique<cpu::Fusion>(vehicle.mapper)) {}

Pipeline::Pipeline(const Vehicle& vehicle, std::size_t max_returns, std::unique_ptr<FusionBackend> fusion)
    : fuser_(std::move(fusion)), layers_(vehicle.mapper.map) {
  for (const LidarGeometry& lidar : vehicle.lidars) mappers_.emplace_back(vehicle.mapper, lidar, max_returns);
}

tl::expected<void, std::string> Pipeline::add(std::size_t lidar, const Sweep& sweep,
                                              const OdometryBuffer& odometry) {
  SweepMapper& mapper = mappers_[lidar];
  const auto shape = mapper.count(sweep, odometry);
  if (!shape) return tl::unexpected(shape.error().what);
  auto map = std::make_unique<BrickMapStorage>();
  if (const auto written = mapper.write(map->resize(*shape)); !written)
    return tl::unexpected(written.error().what);
  const BrickMapView view = map->view(mapper.grid(), sweep.stamp_ns, mapper.T_odom_base());
  const std::uint64_t token = next_token_++;
  window_.emplace(token, std::move(map));
  const auto added = fuser_.add({view, static_cast<int>(lidar), token});
  if (!added) return tl::unexpected(added.error().what);
  if (*added != AddResult::added) return tl::unexpected(std::string("the window refused the sweep's map"));
  for (const WindowMap& left : fuser_.window().left()) window_.erase(left.token);
  return {};
}

const LayerArrays& Pipeline::make_layers() {
  static_cast<void>(fuser_.make_layers(layers_.arrays()));  // fails on a device only
  grid_ = fuser_.moment().grid;
  return layers_.arrays();
}

}  // namespace gvom::mapping
