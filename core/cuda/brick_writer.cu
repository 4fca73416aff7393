#include "core/cuda/brick_writer.hpp"

#include "core/cuda/brick_kernels.hpp"
#include "core/cuda/launch.hpp"

namespace gvom::cuda {

namespace {

constexpr std::int32_t kColumns = kBrickEdge * kBrickEdge;

}  // namespace

BrickWriter::BrickWriter(Device& device, const MapConfig& map, std::size_t most_records)
    : device_(device),
      slots_(grid_around(map, Eigen::Vector3d::Zero()).brick_slots()),
      columns_(grid_around(map, Eigen::Vector3d::Zero()).columns()),
      most_records_(most_records),
      scan_(device, std::size_t{slots_} + 1),
      observed_(device.array<std::uint8_t>(std::size_t{slots_} * kColumns)),
      hit_(device.array<std::uint8_t>(std::size_t{slots_} * kColumns)),
      sizes_(device.array<std::uint64_t>(std::size_t{slots_} + 1)),
      starts_(device.array<std::uint64_t>(std::size_t{slots_} + 1)),
      total_(device.pinned_array<std::uint64_t>(1)),
      made_{device.array<std::int32_t>(slots_), device.array<std::int32_t>(std::size_t{slots_} * kBrickCells),
            device.array<std::uint64_t>(slots_), device.array<float>(columns_),
            device.array<VoxelRecord>(most_records)} {}

void BrickWriter::measure(const DenseBricks& bricks, const Grid& grid) {
  bricks_ = bricks;
  grid_ = grid;
  const BrickWork work{grid, bricks, observed_, hit_, sizes_, starts_};
  const auto slots = static_cast<std::int32_t>(slots_);
  for_each(device_, slots * kColumns, MeasureColumns{work});
  for_each(device_, slots + 1, MeasureBricks{work, slots});
  scan_.exclusive_sum(sizes_, starts_);
  device_.download(total_, starts_ + slots_, sizeof *total_);
}

BrickMapShape BrickWriter::shape() const {
  return {slots_, static_cast<std::uint32_t>(*total_ >> 32), static_cast<std::uint32_t>(*total_), columns_};
}

void BrickWriter::write(const BrickMapArrays& out) {
  const BrickMapShape map = shape();
  if (map.record_count > most_records_) return device_.fail("a map has more records than there is room for");
  const BrickWork work{grid_, bricks_, observed_, hit_, sizes_, starts_};
  const auto slots = static_cast<std::int32_t>(slots_);
  for_each(device_, slots, WriteDirectory{work, made_});
  for_each(device_, slots * kColumns, WriteColumns{work, made_});
  device_.download(out.directory, made_.directory, slots_ * sizeof *out.directory);
  device_.download(out.lookup, made_.lookup, std::size_t{map.brick_count} * kBrickCells * sizeof *out.lookup);
  device_.download(out.columns, made_.columns, map.brick_count * sizeof *out.columns);
  device_.download(out.lowest_ray_m, made_.lowest_ray_m, map.column_count * sizeof *out.lowest_ray_m);
  device_.download(out.records, made_.records, map.record_count * sizeof *out.records);
}

}  // namespace gvom::cuda
