#include "tests/cuda/twins.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/brick_map_storage.hpp"
#include "core/mapper.hpp"
#include "core/open_backend.hpp"
#include "tests/core/random.hpp"
#include "tests/cuda/segment.hpp"
#include "tools/compare/maps.hpp"

namespace gvom::test {

namespace {

constexpr std::size_t kMostReturns = 20'000;
constexpr std::size_t kSegmentBytes = std::size_t{256} << 20;

class Twins {
 public:
  Twins(const Scenario& scenario, std::uint64_t seed)
      : scenario_(scenario),
        random_(seed),
        segment_(kSegmentBytes),
        odometry_(scenario.odometry.size()),
        cpu_(scenario.config),
        cuda_(std::move(open_fusion(Backend::cuda, {scenario.config, int(scenario.lidars.size()),
                                                    kMostReturns, segment_.memory()})
                            .value()
                            .backend)) {
    for (const StampedPose& pose : scenario.odometry) odometry_.add(pose);
    const MapperConfig& config = scenario.config;
    for (const LidarGeometry& lidar : scenario.lidars) {
      cpu_mappers_.emplace_back(config, lidar, kMostReturns);
      const VoxelizerSetup setup{config.map, lidar, config.vehicle, kMostReturns, {}};
      cuda_mappers_.emplace_back(config.map, std::move(open_voxelizer(Backend::cuda, setup).value().backend));
    }
  }

  TwinTally run() {
    for (const Arrival& arrival : scenario_.arrivals) {
      CAPTURE(arrival.lidar, arrival.sweep.stamp_ns);
      take(arrival);
      if (cpu_.window().maps().empty() || random_.chance(0.6)) continue;  // several maps between layers
      compare_layers();
      if (random_.chance(0.3)) compare_voxels();
    }
    return tally_;
  }

 private:
  void take(const Arrival& arrival) {
    SweepMapper& cpu = cpu_mappers_[std::size_t(arrival.lidar)];
    SweepMapper& cuda = cuda_mappers_[std::size_t(arrival.lidar)];
    const auto shape = cpu.count(arrival.sweep, odometry_);
    const auto cuda_shape = cuda.count(arrival.sweep, odometry_);
    REQUIRE(shape.has_value() == cuda_shape.has_value());
    if (!shape) return;
    BrickMapView view{cpu.grid(), arrival.sweep.stamp_ns, record_of(cpu.T_odom_base()), {}};
    REQUIRE(cpu.write(segment_.loan_map(*shape, view)));
    BrickMapStorage storage;
    REQUIRE(cuda.write(storage.resize(*cuda_shape)));
    REQUIRE(compare::map_difference(view, storage.view(view.grid, 0, {})) == "");
    fuse({view, arrival.lidar, next_token_++});
  }

  void fuse(const WindowMap& map) {
    const AddResult result = cpu_.add(map).value();
    REQUIRE(cuda_.add(map).value() == result);
    if (result != AddResult::added) return segment_.give_back(map.view.directory);
    ++tally_.added;
    tally_.most_maps = std::max(tally_.most_maps, static_cast<int>(cuda_.window().maps().size()));
    tally_.most_left = std::max(tally_.most_left, static_cast<int>(cuda_.window().left().size()));
    for (const WindowMap& left : cuda_.window().left()) segment_.give_back(left.view.directory);
  }

  void compare_layers() {
    const int n = scenario_.config.map.size_xy;
    const LayerArrays expected = segment_.loan_layers(n), found = segment_.loan_layers(n);
    REQUIRE(cpu_.make_layers(expected));
    REQUIRE(cuda_.make_layers(found));
    REQUIRE(compare::layers_difference(expected, found, n) == "");
    segment_.give_back(expected.height);
    segment_.give_back(found.height);
    ++tally_.layers;
  }

  void compare_voxels() {
    BrickMapStorage expected, found;
    REQUIRE(cpu_.write_voxels(expected.resize(cpu_.count_voxels().value())));
    REQUIRE(cuda_.write_voxels(found.resize(cuda_.count_voxels().value())));
    const Grid grid = cpu_.moment().grid;
    REQUIRE(compare::map_difference(expected.view(grid, 0, {}), found.view(grid, 0, {})) == "");
  }

  const Scenario& scenario_;
  Random random_;
  Segment segment_;
  OdometryBuffer odometry_;
  MapFuser cpu_;
  MapFuser cuda_;
  std::vector<SweepMapper> cpu_mappers_;
  std::vector<SweepMapper> cuda_mappers_;
  std::uint64_t next_token_ = 0;
  TwinTally tally_;
};

}  // namespace

TwinTally run_twins(const ScenarioSize& size, std::uint64_t seed) {
  CAPTURE(seed, size.size_xy, size.size_z, size.on_faces);
  return run_scenario_twins(random_scenario(seed, size), seed);
}

TwinTally run_scenario_twins(const Scenario& scenario, std::uint64_t seed) {
  return Twins(scenario, seed).run();
}

}  // namespace gvom::test
