#include "services/common/ros/grid_messages.hpp"

#include <algorithm>
#include <array>

#include "services/common/ros/field_types.hpp"
#include "services/common/ros/message_parts.hpp"

namespace gvom::ros {
namespace {

std::array<std::int8_t, 256> occupancy_table() {
  std::array<std::int8_t, 256> table{};
  for (int cost = 1; cost <= 252; ++cost)
    table[static_cast<std::size_t>(cost)] = static_cast<std::int8_t>(1 + 97 * (cost - 1) / 251);
  table[253] = 99;
  table[254] = 100;
  table[255] = -1;
  return table;
}

/// The grid's corner of least x and y, as high as the vehicle.
PoseRecord corner_pose(const LayersView& layers) {
  return level_pose(layers.corner_m(0), layers.corner_m(1), layers.T_odom_base.position_m[2]);
}

PoseRecord centre_pose(const LayersView& layers) {
  const auto centre_m = [&](std::size_t axis) {
    return layers.corner_m(axis) + 0.5 * layers.grid.size[axis] * layers.grid.resolution_m[axis];
  };
  return level_pose(centre_m(0), centre_m(1), layers.T_odom_base.position_m[2]);
}

void write_dimension(CdrWriter& out, const char* label, std::size_t size, std::size_t stride) {
  out.text(label);
  out.count(size);
  out.count(stride);
}

/// std_msgs/Float32MultiArray. Its first value is the column of greatest x and y, its second the next in x:
/// our array reversed.
void write_reversed(CdrWriter& out, const LayersView& layers, LayerId id) {
  const std::size_t columns = layers.columns();
  const auto size_x = static_cast<std::size_t>(layers.grid.size[0]);
  const auto size_y = static_cast<std::size_t>(layers.grid.size[1]);
  out.count(2);
  write_dimension(out, "column_index", size_y, columns);
  write_dimension(out, "row_index", size_x, size_x);
  out.count(0);  // data_offset
  out.count(columns);
  std::uint8_t* to = out.append<float>(columns);
  for (std::size_t i = columns; i-- > 0; to += sizeof(float)) {
    const float value = layers.value(id, i);
    std::memcpy(to, &value, sizeof value);
  }
}

/// A layer into its place in the cells, cell by cell.
void interleave(const LayersView& layers, LayerId id, std::uint8_t* to) {
  const std::size_t bytes = layer_value_bytes(id);
  const auto* from = static_cast<const std::uint8_t*>(layers.arrays[static_cast<std::size_t>(id)]);
  for (std::size_t i = 0; i < layers.columns(); ++i, from += bytes, to += kGridCell_bytes)
    bytes == 1 ? void(*to = *from) : void(std::memcpy(to, from, sizeof(float)));
}

std::uint32_t offset_in_cell(LayerId id) {
  const auto index = static_cast<std::uint32_t>(id);
  constexpr std::uint32_t kFloats = kFloatLayers;
  return index < kFloats ? 4 * index : 4 * kFloats + (index - kFloats);
}
static_assert(4 * kFloatLayers + (kLayers - kFloatLayers) <= kGridCell_bytes);

}  // namespace

std::int8_t occupancy_of(std::uint8_t cost) {
  static const std::array<std::int8_t, 256> table = occupancy_table();
  return table[cost];
}

void write_occupancy_grid(const LayersView& layers, const std::string& frame,
                          std::vector<std::uint8_t>& bytes) {
  CdrWriter out(bytes);
  write_header(out, layers.stamp_ns, frame);
  write_time(out, layers.stamp_ns);
  out.number(static_cast<float>(layers.grid.resolution_m[0]));
  out.count(static_cast<std::size_t>(layers.grid.size[0]));
  out.count(static_cast<std::size_t>(layers.grid.size[1]));
  write_pose(out, corner_pose(layers));
  out.count(layers.columns());
  const auto* cost = static_cast<const std::uint8_t*>(layers.arrays[static_cast<int>(LayerId::cost)]);
  std::transform(cost, cost + layers.columns(), out.append<std::uint8_t>(layers.columns()),
                 [](std::uint8_t c) { return static_cast<std::uint8_t>(occupancy_of(c)); });
}

void write_grid_map(const LayersView& layers, const std::vector<LayerId>& chosen, const std::string& frame,
                    std::vector<std::uint8_t>& bytes) {
  CdrWriter out(bytes);
  write_header(out, layers.stamp_ns, frame);
  out.number(layers.grid.resolution_m[0]);
  out.number(layers.grid.size[0] * layers.grid.resolution_m[0]);
  out.number(layers.grid.size[1] * layers.grid.resolution_m[1]);
  write_pose(out, centre_pose(layers));
  out.count(chosen.size());
  for (const LayerId id : chosen) out.text(name_of(id));
  out.count(std::min<std::size_t>(chosen.size(), 1));
  if (!chosen.empty()) out.text(name_of(chosen.front()));
  out.count(chosen.size());
  for (const LayerId id : chosen) write_reversed(out, layers, id);
  out.number(std::uint16_t{0});  // outer and inner start index: it begins at its corner
  out.number(std::uint16_t{0});
}

void write_foxglove_grid(const LayersView& layers, const std::string& frame,
                         std::vector<std::uint8_t>& bytes) {
  CdrWriter out(bytes);
  write_header(out, layers.stamp_ns, frame);
  write_pose(out, corner_pose(layers));
  const auto size_x = static_cast<std::uint32_t>(layers.grid.size[0]);
  out.number(size_x);
  out.number(layers.grid.resolution_m[0]);
  out.number(layers.grid.resolution_m[1]);
  out.number(size_x * kGridCell_bytes);
  out.number(kGridCell_bytes);
  out.count(kLayers);
  for (int i = 0; i < kLayers; ++i) {
    const auto id = static_cast<LayerId>(i);
    out.text(name_of(id));
    out.number(offset_in_cell(id));
    out.number(layer_value_bytes(id) == 1 ? foxglove::kUint8 : foxglove::kFloat32);
  }
  const std::size_t data_bytes = layers.columns() * kGridCell_bytes;
  out.count(data_bytes);
  std::uint8_t* data = out.append<std::uint8_t>(data_bytes);
  for (std::size_t i = 0; i < layers.columns(); ++i) data[(i + 1) * kGridCell_bytes - 1] = 0;  // padding
  for (int i = 0; i < kLayers; ++i)
    interleave(layers, static_cast<LayerId>(i), data + offset_in_cell(static_cast<LayerId>(i)));
}

}  // namespace gvom::ros
