#include "tools/map/output.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/brick_map_storage.hpp"
#include "tools/common/npy.hpp"

namespace gvom::tools {

namespace {

constexpr const char* kFloatNames[] = {"height",    "inferred_height", "slope_x",          "slope_y",
                                       "slope",     "roughness",       "obstacle_density", "negative_delta",
                                       "clearance", "last_seen"};
constexpr const char* kByteNames[] = {"flags", "visibility", "cost"};

struct VoxelRow {
  std::int32_t x, y, z;  // world voxel
  std::uint32_t hits, passes;
  float min_height_m;  // +infinity where hits is 0
};

nlohmann::json source_counts(const ingest::SourceCounters& c) {
  return {{"packets", c.packets},
          {"sweeps", c.sweeps},
          {"incomplete_sweeps", c.incomplete_sweeps},
          {"dropped_sweeps", c.dropped_sweeps},
          {"misfit_sweeps", c.misfit_sweeps},
          {"foreign_packets", c.foreign_packets},
          {"second_sensor_packets", c.second_sensor_packets},
          {"truncated_packets", c.truncated_packets},
          {"duplicate_packets", c.duplicate_packets},
          {"out_of_order_packets", c.out_of_order_packets},
          {"late_packets", c.late_packets},
          {"fragments", c.fragments},
          {"lost_fragments", c.lost_fragments},
          {"invalid_columns", c.invalid_columns},
          {"overflow_returns", c.overflow_returns}};
}

}  // namespace

LayerBuffers::LayerBuffers(int size_xy) : size_xy_(static_cast<std::size_t>(size_xy)) {
  floats_.assign(std::size(kFloatNames), std::vector<float>(size_xy_ * size_xy_));
  bytes_.assign(std::size(kByteNames), std::vector<std::uint8_t>(size_xy_ * size_xy_));
}

LayerArrays LayerBuffers::arrays() {
  const auto f = [this](std::size_t i) { return floats_[i].data(); };
  return {f(0),
          f(1),
          f(2),
          f(3),
          f(4),
          f(5),
          f(6),
          f(7),
          f(8),
          f(9),
          bytes_[0].data(),
          bytes_[1].data(),
          bytes_[2].data()};
}

tl::expected<void, std::string> LayerBuffers::write(const std::string& folder) const {
  const std::vector<std::size_t> shape{size_xy_, size_xy_};
  tl::expected<void, std::string> written;
  for (std::size_t i = 0; written && i < floats_.size(); ++i)
    written = npy::write_npy(folder + "/" + kFloatNames[i] + ".npy", shape, floats_[i].data());
  for (std::size_t i = 0; written && i < bytes_.size(); ++i)
    written = npy::write_npy(folder + "/" + kByteNames[i] + ".npy", shape, bytes_[i].data());
  return written;
}

tl::expected<void, std::string> write_meta(const std::string& folder, const OfflineMapper& mapper,
                                           const MappedSweep& sweep) {
  const LayerMoment moment = mapper.fuser().moment();
  const Grid& grid = moment.grid;
  const Eigen::Vector3d& base_m = moment.T_odom_base.translation_m;
  const Eigen::Quaterniond& q = moment.T_odom_base.rotation;
  const FilterCounts& filter = sweep.filter;
  nlohmann::json meta = {{"stamp_ns", moment.stamp_ns},
                         {"origin", grid.origin},
                         {"size", grid.size},
                         {"resolution_m", {grid.resolution_m[0], grid.resolution_m[2]}},
                         {"maps_in_window", mapper.fuser().window().maps().size()},
                         {"base_position_m", {base_m.x(), base_m.y(), base_m.z()}},
                         {"base_orientation_xyzw", {q.x(), q.y(), q.z(), q.w()}},
                         {"lidar", sweep.lidar},
                         {"sweep_complete", sweep.complete},
                         {"returns", filter.used},
                         {"dropped",
                          {{"not_finite", filter.not_finite},
                           {"too_near", filter.too_near},
                           {"too_far", filter.too_far},
                           {"body", filter.body}}},
                         {"sweeps_without_odometry", mapper.sweeps_without_odometry()},
                         {"maps_refused", mapper.maps_refused()}};
  meta["backend"]["fusion"] = mapper.fusion_backend().name;
  for (const OfflineMapper::Lidar& lidar : mapper.lidars()) {
    meta["backend"]["lidars"][lidar.name] = lidar.backend.name;
    meta["sources"][lidar.name] = source_counts(lidar.source->counters());
  }
  std::ofstream file(folder + "/meta.json");
  file << meta.dump(2) << '\n';
  if (!file.flush()) return tl::unexpected(folder + "/meta.json: cannot be written");
  return {};
}

tl::expected<void, std::string> write_voxels(const std::string& folder, MapFuser& fuser) {
  const auto shape = fuser.count_voxels();
  if (!shape) return tl::unexpected(shape.error().what);
  BrickMapStorage storage;
  if (const auto written = fuser.write_voxels(storage.resize(*shape)); !written)
    return tl::unexpected(written.error().what);
  const Grid grid = fuser.moment().grid;
  const BrickMapView map = storage.view(grid, 0, {});
  std::vector<VoxelRow> rows;
  for (std::int32_t z = 0; z < grid.size[2]; ++z)
    for (std::int32_t y = 0; y < grid.size[1]; ++y)
      for (std::int32_t x = 0; x < grid.size[0]; ++x) {
        const Int3 world{grid.origin[0] + x, grid.origin[1] + y, grid.origin[2] + z};
        const VoxelRecord voxel = map.voxel_at(world);
        if (voxel.hits + voxel.passes == 0) continue;
        rows.push_back({world[0], world[1], world[2], voxel.hits, voxel.passes, voxel.min_height_m});
      }
  return npy::write_npy_records(
      folder + "/voxels.npy",
      {{"x", "<i4"}, {"y", "<i4"}, {"z", "<i4"}, {"hits", "<u4"}, {"passes", "<u4"}, {"min_height", "<f4"}},
      rows);
}

}  // namespace gvom::tools
