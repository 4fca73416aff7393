#include "services/common/ros/cloud_messages.hpp"

#include <cmath>
#include <string_view>

#include "services/common/ros/field_types.hpp"
#include "services/common/ros/message_parts.hpp"

namespace gvom::ros {
namespace {

/// All of a cloud of float32 fields but its points.
void write_cloud_head(CdrWriter& out, std::int64_t stamp_ns, const std::string& frame,
                      const std::vector<std::string_view>& fields, std::size_t points) {
  write_header(out, stamp_ns, frame);
  out.count(1);  // height: not organised
  out.count(points);
  out.count(fields.size());
  std::uint32_t offset = 0;
  for (const std::string_view field : fields) {
    out.text(field);
    out.number(offset);
    out.number(point_field::kFloat32);
    out.count(1);
    offset += sizeof(float);
  }
  out.number(std::uint8_t{0});  // is_bigendian
  out.number(offset);
  out.number(static_cast<std::uint32_t>(offset * points));
  out.count(offset * points);
}

/// Appends float32 after float32, not aligned: the data of a cloud are octets.
class FloatsOut {
 public:
  explicit FloatsOut(std::uint8_t* to) : to_(to) {}
  void add(float value) {
    std::memcpy(to_, &value, sizeof value);
    to_ += sizeof value;
  }

 private:
  std::uint8_t* to_;
};

}  // namespace

void write_columns_cloud(const LayersView& layers, const std::vector<LayerId>& chosen,
                         const std::string& frame, std::vector<std::uint8_t>& bytes) {
  const auto* height = static_cast<const float*>(layers.arrays[static_cast<int>(LayerId::height)]);
  std::size_t points = 0;
  for (std::size_t i = 0; i < layers.columns(); ++i) points += std::isnan(height[i]) ? 0 : 1;
  std::vector<std::string_view> fields = {"x", "y", "z"};
  for (const LayerId id : chosen) fields.push_back(name_of(id));

  CdrWriter out(bytes);
  write_cloud_head(out, layers.stamp_ns, frame, fields, points);
  FloatsOut floats(out.append<std::uint8_t>(points * fields.size() * sizeof(float)));
  for (std::int32_t y = 0; y < layers.grid.size[1]; ++y)
    for (std::int32_t x = 0; x < layers.grid.size[0]; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * layers.grid.size[0] + x;
      if (std::isnan(height[i])) continue;
      const auto centre_m = layers.grid.center_m({layers.grid.origin[0] + x, layers.grid.origin[1] + y, 0});
      floats.add(static_cast<float>(centre_m[0]));
      floats.add(static_cast<float>(centre_m[1]));
      floats.add(height[i]);
      for (const LayerId id : chosen) floats.add(layers.value(id, i));
    }
  out.number(std::uint8_t{1});  // is_dense
}

void write_voxels_cloud(const BrickMapView& map, const std::string& frame, std::vector<std::uint8_t>& bytes) {
  std::size_t points = 0;
  map.for_each_hit([&](const Int3&, const VoxelRecord&) { ++points; });
  const std::vector<std::string_view> fields = {"x", "y", "z", "density"};

  CdrWriter out(bytes);
  write_cloud_head(out, map.stamp_ns, frame, fields, points);
  FloatsOut floats(out.append<std::uint8_t>(points * fields.size() * sizeof(float)));
  map.for_each_hit([&](const Int3& world, const VoxelRecord& voxel) {
    for (const double coordinate_m : map.grid.center_m(world)) floats.add(static_cast<float>(coordinate_m));
    const double seen = static_cast<double>(voxel.hits) + voxel.passes;
    floats.add(static_cast<float>(voxel.hits / seen));
  });
  out.number(std::uint8_t{1});  // is_dense
}

}  // namespace gvom::ros
