#include "tests/core/compare.hpp"

#include <cmath>
#include <cstring>
#include <sstream>

#include "core/brick_map_storage.hpp"

namespace gvom::test {

namespace {

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream out;
  out.precision(17);
  (out << ... << parts);
  return out.str();
}

std::string place(int x, int y, int z) {
  return text(" at (", x, ", ", y, ", ", z, ") from the origin");
}

bool same_bits(float a, float b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::memcmp(&a, &b, sizeof a) == 0;
}

std::string words(const oracle::Voxel& voxel) {
  return text("hits ", voxel.hits, " passes ", voxel.passes, " lowest ", voxel.min_height_m);
}

// One brick of a map, from its origin at (x, y, z); counts its records on.
class BrickCheck {
 public:
  BrickCheck(const BrickMapView& map, const oracle::VoxelBox& voxels) : map_(map), voxels_(voxels) {}

  std::string check(int bx, int by, int bz) {
    const Int3 n = map_.grid.bricks();
    const std::int32_t brick = map_.directory[(bz * n[1] + by) * n[0] + bx];
    if (brick != -1 && brick != bricks_) return text("brick ", brick, " where ", bricks_, " or -1 is due");
    bool any = false;
    std::uint64_t columns = 0;
    for (int cell = 0; cell < kBrickCells; ++cell) {
      const int x = bx * 8 + cell / 64, y = by * 8 + cell / 8 % 8, z = bz * 8 + cell % 8;
      const oracle::Voxel& voxel = voxels_.local(x, y, z);
      any |= voxel.observed();
      if (voxel.observed()) columns |= std::uint64_t{1} << (cell / 8);
      if (brick == -1) continue;
      const std::string wrong =
          check_cell(map_.lookup[std::size_t(brick) * kBrickCells + std::size_t(cell)], voxel);
      if (!wrong.empty()) return wrong + place(x, y, z);
    }
    if (any != (brick != -1))
      return text(any ? "no brick " : "an empty brick ") + place(bx * 8, by * 8, bz * 8);
    if (brick != -1 && map_.columns[bricks_++] != columns)
      return "columns of brick" + place(bx * 8, by * 8, bz * 8);
    return {};
  }

  std::string check_counts() const {
    const bool right =
        map_.shape.brick_count == std::uint32_t(bricks_) && map_.shape.record_count == records_;
    return right ? ""
                 : text("shape says ", map_.shape.brick_count, " bricks, ", map_.shape.record_count,
                        " records");
  }

 private:
  std::string check_cell(std::int32_t lookup, const oracle::Voxel& voxel) {
    if (voxel.hits == 0) {
      const auto due = static_cast<std::int32_t>(-1 - std::int64_t{voxel.passes});
      return lookup == due ? "" : text("lookup ", lookup, " where ", due, " is due");
    }
    if (lookup != static_cast<std::int32_t>(records_))
      return text("record ", lookup, " where ", records_, " is due");
    const VoxelRecord& record = map_.records[records_++];
    const oracle::Voxel found{record.hits, record.passes, record.min_height_m};
    const bool same = found.hits == voxel.hits && found.passes == voxel.passes &&
                      same_bits(found.min_height_m, voxel.min_height_m);
    return same ? "" : words(found) + ", due: " + words(voxel);
  }

  const BrickMapView& map_;
  const oracle::VoxelBox& voxels_;
  std::int32_t bricks_ = 0;
  std::uint32_t records_ = 0;
};

std::string column_difference(const FusedView& map, const oracle::VoxelBox& voxels, int min_hits, int x,
                              int y) {
  for (int z = 0; z < map.n_z; ++z) {
    const oracle::Voxel& voxel = voxels.local(x, y, z);
    const std::size_t cell = map.cell(x, y, z);
    const oracle::Voxel found{map.hits[cell], map.passes[cell], map.min_height_m[cell]};
    if (found.hits != voxel.hits || found.passes != voxel.passes ||
        (voxel.hits > 0 && !same_bits(found.min_height_m, voxel.min_height_m)))
      return "fused " + words(found) + ", due: " + words(voxel) + place(x, y, z);
    const std::size_t word = map.column(x, y) * std::size_t(map.words) + std::size_t(z / 64);
    const bool occupied = (map.occupied[word] >> (z % 64) & 1) != 0,
               free = (map.free[word] >> (z % 64) & 1) != 0;
    const bool is_occupied = voxel.hits >= static_cast<unsigned>(min_hits);
    if (occupied != is_occupied) return text("occupied is ", occupied) + place(x, y, z);
    if (free != (voxel.observed() && !is_occupied)) return text("free is ", free) + place(x, y, z);
  }
  return {};
}

template <class T, class Same>
std::string layer_difference(const char* name, const std::vector<T>& layer, const std::vector<T>& expected,
                             int n, Same same) {
  if (layer.size() != expected.size()) return text(name, ": ", layer.size(), " values");
  for (std::size_t i = 0; i < layer.size(); ++i)
    if (!same(layer[i], expected[i]))
      return text(name, " is ", +layer[i], ", due: ", +expected[i], " at column (", i % std::size_t(n), ", ",
                  i / std::size_t(n), ")");
  return {};
}

}  // namespace

std::string difference(const BrickMapView& map, const oracle::VoxelBox& voxels) {
  const Int3 n = map.grid.bricks();
  if (map.shape.brick_slots != std::uint32_t(n[0] * n[1] * n[2])) return "brick slots";
  BrickCheck bricks(map, voxels);
  for (int bz = 0; bz < n[2]; ++bz)
    for (int by = 0; by < n[1]; ++by)
      for (int bx = 0; bx < n[0]; ++bx) {
        std::string wrong = bricks.check(bx, by, bz);
        if (!wrong.empty()) return wrong;
      }
  return bricks.check_counts();
}

std::string difference(const BrickMapView& map, const oracle::BufferMap& expected) {
  if (map.grid.origin != expected.grid.origin) return "origin of the map";
  if (!map.grid.same_shape(expected.grid)) return "shape of the map";
  if (map.stamp_ns != expected.stamp_ns) return "stamp of the map";
  oracle::VoxelBox voxels(expected.grid);
  for (const oracle::WorldVoxel& one : expected.observed) voxels[one.at] = one.voxel;
  return difference(map, voxels);
}

std::string difference(const FusedView& map, const oracle::Fusion& expected, int min_hits) {
  const oracle::VoxelBox voxels = expected.voxels();
  const std::vector<std::int64_t> newest_ns = oracle::newest_stamps(expected);
  for (int y = 0; y < map.n_xy; ++y)
    for (int x = 0; x < map.n_xy; ++x) {
      std::string wrong = column_difference(map, voxels, min_hits, x, y);
      if (!wrong.empty()) return wrong;
      const std::int64_t due_ns = newest_ns[std::size_t(y) * std::size_t(map.n_xy) + std::size_t(x)];
      const std::int64_t found_ns = map.last_seen_ns[map.column(x, y)];
      if (found_ns != due_ns) return text("last seen ", found_ns, ", due: ", due_ns) + place(x, y, 0);
    }
  return {};
}

std::string difference(const oracle::Layers& layers, const oracle::Layers& expected) {
  using L = oracle::Layers;
  constexpr std::pair<const char*, std::vector<float> L::*> kFloats[] = {
      {"height", &L::height},       {"inferred_height", &L::inferred_height},
      {"slope_x", &L::slope_x},     {"slope_y", &L::slope_y},
      {"slope", &L::slope},         {"roughness", &L::roughness},
      {"clearance", &L::clearance}, {"obstacle_density", &L::obstacle_density},
      {"last_seen", &L::last_seen}, {"negative_delta", &L::negative_delta}};
  constexpr std::pair<const char*, std::vector<std::uint8_t> L::*> kBytes[] = {
      {"flags", &L::flags}, {"visibility", &L::visibility}, {"cost", &L::cost}};
  std::string wrong;
  for (const auto& [name, layer] : kFloats)
    if (wrong.empty()) wrong = layer_difference(name, layers.*layer, expected.*layer, layers.n, same_bits);
  for (const auto& [name, layer] : kBytes)
    if (wrong.empty())
      wrong = layer_difference(name, layers.*layer, expected.*layer, layers.n, std::equal_to<>());
  return wrong;
}

const cpu::FusedMap* cpu_map(const MapFuser& fuser) {
  const auto* backend = dynamic_cast<const cpu::Fusion*>(&fuser.backend());
  return backend == nullptr ? nullptr : &backend->map();
}

std::string export_difference(MapFuser& fuser, const oracle::Fusion& expected) {
  const auto shape = fuser.count_voxels();
  if (!shape) return shape.error().what;
  BrickMapStorage storage;
  if (const auto written = fuser.write_voxels(storage.resize(*shape)); !written) return written.error().what;
  const oracle::VoxelBox voxels = expected.voxels();
  const Grid grid = fuser.moment().grid;
  if (grid.origin != voxels.grid().origin) return "origin of the fused map";
  const std::string wrong = difference(storage.view(grid, 0, {}), voxels);
  return wrong.empty() ? wrong : "exported: " + wrong;
}

}  // namespace gvom::test
