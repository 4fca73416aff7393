#include "tests/core/compare.hpp"

#include <cmath>
#include <cstring>
#include <sstream>

#include "core/brick_map_storage.hpp"
#include "tools/compare/maps.hpp"

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

// The one form that a map of these voxels may have (R6): bricks in order of slots, only such with an observed
// voxel, records in order of bricks and cells.
class BrickMapOf {
 public:
  BrickMapOf(const oracle::VoxelBox& voxels, const oracle::ColumnHeights& lowest_ray) : voxels_(voxels) {
    const Int3 n = voxels.grid().bricks();
    for (int bz = 0; bz < n[2]; ++bz)
      for (int by = 0; by < n[1]; ++by)
        for (int bx = 0; bx < n[0]; ++bx) add_brick({bx * kBrickEdge, by * kBrickEdge, bz * kBrickEdge});
    for (int by = 0; by < n[1]; ++by)
      for (int bx = 0; bx < n[0]; ++bx) add_stack(lowest_ray, bx * kBrickEdge, by * kBrickEdge);
  }

  [[nodiscard]] BrickMapView view() const {
    BrickMapView map;
    map.shape = {std::uint32_t(directory_.size()), std::uint32_t(columns_.size()),
                 std::uint32_t(records_.size()), std::uint32_t(lowest_ray_m_.size())};
    map.directory = directory_.data();
    map.lookup = lookup_.data();
    map.columns = columns_.data();
    map.lowest_ray_m = lowest_ray_m_.data();
    map.records = records_.data();
    return map;
  }

 private:
  // The brick at `corner` from the origin.
  void add_brick(const Int3& corner) {
    std::uint64_t columns = 0;
    for (int cell = 0; cell < kBrickCells; ++cell)
      if (at(corner, cell).observed()) columns |= std::uint64_t{1} << (cell / kBrickEdge);
    directory_.push_back(columns == 0 ? -1 : int(columns_.size()));
    if (columns == 0) return;
    columns_.push_back(columns);
    for (int cell = 0; cell < kBrickCells; ++cell) add_cell(at(corner, cell));
  }

  void add_cell(const oracle::Voxel& voxel) {
    lookup_.push_back(voxel.hits > 0 ? int(records_.size()) : int(-1 - std::int64_t{voxel.passes}));
    if (voxel.hits > 0) records_.push_back({voxel.hits, voxel.passes, voxel.min_height_m});
  }

  // Columns lie as a brick's do: y fastest.
  void add_stack(oracle::ColumnHeights lowest_ray, int x, int y) {
    for (int column = 0; column < kBrickColumns; ++column)
      lowest_ray_m_.push_back(*lowest_ray.at(x + column / kBrickEdge, y + column % kBrickEdge));
  }

  [[nodiscard]] const oracle::Voxel& at(const Int3& corner, int cell) const {
    return voxels_.local(corner[0] + cell / 64, corner[1] + cell / 8 % 8, corner[2] + cell % 8);
  }

  const oracle::VoxelBox& voxels_;
  std::vector<std::int32_t> directory_;
  std::vector<std::int32_t> lookup_;
  std::vector<std::uint64_t> columns_;
  std::vector<float> lowest_ray_m_;
  std::vector<VoxelRecord> records_;
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
    const std::uint64_t* const memory = map.memory.remembered;
    const bool remembered = memory != nullptr && (memory[word] >> (z % 64) & 1) != 0;
    if (remembered != voxel.remembered) return text("remembered is ", remembered) + place(x, y, z);
  }
  return {};
}

}  // namespace

std::string difference(const BrickMapView& map, const oracle::VoxelBox& voxels,
                       const oracle::ColumnHeights& lowest_ray) {
  return compare::map_difference(BrickMapOf(voxels, lowest_ray).view(), map, compare::Same::values);
}

std::string difference(const BrickMapView& map, const oracle::BufferMap& expected) {
  if (map.grid.origin != expected.grid.origin) return "origin of the map";
  if (!map.grid.same_shape(expected.grid)) return "shape of the map";
  if (map.stamp_ns != expected.stamp_ns) return "stamp of the map";
  oracle::VoxelBox voxels(expected.grid);
  for (const oracle::WorldVoxel& one : expected.observed) voxels[one.at] = one.voxel;
  return difference(map, voxels, expected.lowest_ray);
}

std::string difference(const FusedView& map, const oracle::Fusion& expected, int min_hits) {
  const oracle::VoxelBox voxels = expected.shown_voxels();
  const std::vector<std::int64_t> newest_ns = oracle::newest_stamps(expected);
  oracle::ColumnHeights lowest_ray = expected.lowest_ray(), remembered_ray = expected.remembered_ray();
  for (int y = 0; y < map.n_xy; ++y)
    for (int x = 0; x < map.n_xy; ++x) {
      std::string wrong = column_difference(map, voxels, min_hits, x, y);
      if (!wrong.empty()) return wrong;
      const std::int64_t due_ns = newest_ns[std::size_t(y) * std::size_t(map.n_xy) + std::size_t(x)];
      const std::int64_t found_ns = map.last_seen_ns[map.column(x, y)];
      if (found_ns != due_ns) return text("last seen ", found_ns, ", due: ", due_ns) + place(x, y, 0);
      const float found_m = map.lowest_ray_m[map.stacked_column(x, y)];
      if (!same_bits(found_m, *lowest_ray.at(x, y)))
        return text("lowest ray ", found_m, ", due: ", *lowest_ray.at(x, y)) + place(x, y, 0);
      if (map.memory.lowest_ray_m == nullptr) continue;
      const float remembered_m = map.memory.lowest_ray_m[map.stacked_column(x, y)];
      if (!same_bits(remembered_m, *remembered_ray.at(x, y)))
        return text("remembered ray ", remembered_m, ", due: ", *remembered_ray.at(x, y)) + place(x, y, 0);
    }
  return {};
}

std::string difference(oracle::Layers layers, oracle::Layers expected) {
  if (layers.n != expected.n) return text(layers.n, " columns a side, due: ", expected.n);
  return compare::layers_difference(expected.arrays(), layers.arrays(), layers.n, compare::Same::values);
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
  const std::string wrong = difference(storage.view(grid, 0, {}), voxels, expected.lowest_ray());
  return wrong.empty() ? wrong : "exported: " + wrong;
}

}  // namespace gvom::test
