// core's own pipeline in one process: sweeps in, layers out.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include <tl/expected.hpp>

#include "core/brick_map_storage.hpp"
#include "core/mapper.hpp"

namespace gvom::mapping {

/// What maps, and with which lidars.
struct Vehicle {
  MapperConfig mapper;
  std::vector<LidarGeometry> lidars;
};

/// All layers of a map, as LayerArrays has them.
class LayerStorage {
 public:
  explicit LayerStorage(const MapConfig& map);

  [[nodiscard]] const LayerArrays& arrays() const { return arrays_; }

 private:
  std::vector<float> floats_;
  std::vector<std::uint8_t> bytes_;
  LayerArrays arrays_{};
};

class Pipeline {
 public:
  /// `max_returns`: the most that a sweep can have.
  Pipeline(const Vehicle& vehicle, std::size_t max_returns);
  /// With something else than core's own fusion on the CPU.
  Pipeline(const Vehicle& vehicle, std::size_t max_returns, std::unique_ptr<FusionBackend> fusion);

  /// Maps and fuses a sweep of the lidar with this index. Errors say why it was not.
  tl::expected<void, std::string> add(std::size_t lidar, const Sweep& sweep, const OdometryBuffer& odometry);

  /// Of what is fused so far; valid until the next call. At least one sweep must have been added.
  const LayerArrays& make_layers();
  /// Of the newest sweep.
  [[nodiscard]] const Grid& grid() const { return grid_; }

 private:
  std::vector<SweepMapper> mappers_;
  // The fuser reads what the window holds, so the window goes after it.
  std::unordered_map<std::uint64_t, std::unique_ptr<BrickMapStorage>> window_;  // by token
  MapFuser fuser_;
  LayerStorage layers_;
  Grid grid_;
  std::uint64_t next_token_ = 0;
};

}  // namespace gvom::mapping
