// Sweeps of a lidar that moves lie on each other when they are placed by the odometry (R3).
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <set>
#include <string>

#include "core/brick_map_storage.hpp"
#include "services/common/config_file.hpp"
#include "tests/support/recordings.hpp"
#include "tools/map/offline.hpp"

namespace gvom::test {
namespace {

using Voxels = std::set<std::array<std::int32_t, 3>>;

Voxels hit_voxels(MapFuser& fuser) {
  BrickMapStorage storage;
  REQUIRE(fuser.write_voxels(storage.resize(fuser.count_voxels().value())));
  const Grid grid = fuser.moment().grid;
  const BrickMapView map = storage.view(grid, 0, {});
  Voxels voxels;
  for (std::int32_t z = 0; z < grid.size[2]; ++z)
    for (std::int32_t y = 0; y < grid.size[1]; ++y)
      for (std::int32_t x = 0; x < grid.size[0]; ++x) {
        const Int3 world{grid.origin[0] + x, grid.origin[1] + y, grid.origin[2] + z};
        if (map.voxel_at(world).hits > 0) voxels.insert(world);
      }
  return voxels;
}

// Of the 0.1 m voxels that the first sweep hits within 25 m, the share that the third hits too.
double overlap_of_first_and_third(const std::string& folder, const std::string& odometry) {
  auto config = services::load_vehicle_config(
      GVOM_SOURCE_DIR "/config/vehicles/ouster_os1_128.yaml",
      {"lidars.top.source=ouster:" + folder + "/os1_128.pcap?meta=" + folder + "/os1_128.json",
       "window.buffer_size=1", "map.resolution_xy_m=0.1", "map.resolution_z_m=0.1", "map.size_xy=512"});
  REQUIRE(config);
  auto mapper = tools::OfflineMapper::open(*config, odometry);
  REQUIRE(mapper);
  std::array<Voxels, 3> sweeps;
  tools::MappedSweep mapped;
  for (Voxels& voxels : sweeps) {
    REQUIRE(mapper->next(mapped).value());
    voxels = hit_voxels(mapper->fuser());
  }
  double both = 0;
  for (const auto& voxel : sweeps[0]) both += static_cast<double>(sweeps[2].count(voxel));
  return both / static_cast<double>(sweeps[0].size());
}

TEST_CASE("three sweeps of a moving OS1-128 overlap where the odometry puts them") {
  const auto data = recordings();
  if (!data) return;
  const std::string folder = *data + "/ouster_os1_128_moving";
  const double placed = overlap_of_first_and_third(folder, "tum:" + folder + "/odometry.tum");
  const double left_lying = overlap_of_first_and_third(folder, "static");
  INFO("overlap with odometry " << placed << ", without " << left_lying);
  CHECK(placed > 0.4);
  CHECK(left_lying < 0.35);  // half a metre of motion between them
}

}  // namespace
}  // namespace gvom::test
