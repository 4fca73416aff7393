// How the CUDA back end deals with the host's memory: on the fake device, which can be told to.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>

#include "core/brick_map_storage.hpp"
#include "core/mapper.hpp"
#include "core/open_backend.hpp"
#include "tests/cuda/drive.hpp"
#include "tests/cuda/segment.hpp"
#include "tests/cuda/twins.hpp"
#include "tests/fake_cuda/fake_cuda.hpp"

namespace gvom::test {
namespace {

// Tells the fake device something for as long as it lives.
struct Told {
  explicit Told(void (*tell)(bool)) : tell_(tell) { tell_(true); }
  ~Told() { tell_(false); }
  void (*tell_)(bool);
};

TEST_CASE(
    "CUDA: a device that shares the host's memory reads maps in place, for as long as they may be read") {
  const Told shares(fake_cuda::share_host_memory);
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    CHECK(run_twins({64, 32, 30, 300, false}, 6000 + seed).added > 5);
}

TEST_CASE("CUDA: where memory cannot be pinned copies are staged, and the details say so") {
  const Told refuses(fake_cuda::refuse_to_pin);
  CHECK(run_twins({64, 32, 30, 300, false}, 6100).added > 5);
  Segment segment(1 << 20);
  const auto opened = open_fusion(Backend::cuda, {MapperConfig{}, 1, 100, segment.memory()});
  REQUIRE(opened);
  CHECK(opened->name == "cuda");
  CHECK(opened->details.find("staged copies") != std::string::npos);
  CHECK(opened->details.find("not supported") != std::string::npos);
}

TEST_CASE(
    "CUDA: a steady tick takes no memory, always the same kernels, waits once and sends what is pinned") {
  const auto drive = Drive::open(Backend::cuda).value();
  for (int i = 0; i < 20; ++i) REQUIRE(drive->step());
  const fake_cuda::Counts before = fake_cuda::counts();
  for (int i = 0; i < 200; ++i) {
    const std::uint64_t waits = fake_cuda::counts().waits;
    REQUIRE(drive->step());
    REQUIRE(drive->costs()->launches == 14);
    // Two of them are the voxelizer's: its map's size, and the map.
    REQUIRE(fake_cuda::counts().waits == waits + 3);
  }
  CHECK(fake_cuda::counts().allocations == before.allocations);
  CHECK(fake_cuda::counts().pageable_uploads == before.pageable_uploads);
}

TEST_CASE("CUDA: the window's maps take the memory that they need, not what they could need at most") {
  MapperConfig config;
  config.map = {0.4, 0.4, 256, 64};
  config.window.buffer_size = 100;
  const std::size_t before = fake_cuda::device_bytes();
  const auto opened = open_fusion(Backend::cuda, {config, 1, 131'072, {}});
  REQUIRE(opened);
  // 256 x 256 x 64 voxels of 12 bytes, twice, and some; 100 maps of all bricks would be 1.8 GB more.
  CHECK(fake_cuda::device_bytes() - before < std::size_t{300} << 20);
}

TEST_CASE("CUDA: what the device and its objects took is given back") {
  REQUIRE(fake_cuda::leftovers().empty());
  {
    const auto drive = Drive::open(Backend::cuda).value();
    for (int i = 0; i < 20; ++i) REQUIRE(drive->step());
    CHECK_FALSE(fake_cuda::leftovers().empty());
  }
  CHECK(fake_cuda::leftovers().empty());
}

TEST_CASE("CUDA: a place that a map outgrows gives its memory back for more") {
  MapperConfig config;
  config.map = {0.4, 0.4, 256, 64};
  config.window.buffer_size = 1;
  const std::size_t before = fake_cuda::device_bytes();
  {
    MapFuser fuser(open_fusion(Backend::cuda, {config, 1, 40'000, {}}).value().backend);
    SweepMapper mapper(config, {}, 40'000);
    OdometryBuffer odometry;
    BrickMapStorage storage;
    const std::size_t opened = fake_cuda::device_bytes();
    std::size_t largest = 0;
    for (std::int64_t i = 1; i <= 12; ++i) {
      Sweep sweep;
      sweep.stamp_ns = i;
      sweep.times_ns = {i};
      for (int k = 0; k < 3000 * i; ++k)
        sweep.returns.push_back(
            {4.0 * double(i) * std::sin(k), 4.0 * double(i) * std::cos(k), 10.0 * std::sin(7 * k), 0});
      odometry.add({i, {}});
      REQUIRE(mapper.write(storage.resize(mapper.count(sweep, odometry).value())));
      BrickMapView view = storage.view(mapper.grid(), i, mapper.T_odom_base());
      largest = std::max(largest, std::size_t{view.shape.brick_count} * kBrickCells * 4);
      REQUIRE(fuser.add({view, 0, 0}) == AddResult::added);
      REQUIRE(fuser.make_layers(Segment(16 << 20).loan_layers(256)));
    }
    REQUIRE(largest > std::size_t{3} << 20);
    // Three places, each with a quarter to spare and rounded up, of a map that is little more than its lookup
    // values.
    CHECK(fake_cuda::device_bytes() - opened < 3 * (largest * 3 / 2 + (std::size_t{1} << 20)));
  }
  CHECK(fake_cuda::device_bytes() == before);
  CHECK(fake_cuda::leftovers().empty());
}

TEST_CASE("CUDA: a sweep with more returns than there is room for is counted whole") {
  for (const std::size_t room : {1, 7, 1000}) {
    const VoxelizerSetup setup{{0.4, 0.4, 64, 32}, {}, {}, room, {}};
    const auto cuda = open_voxelizer(Backend::cuda, setup).value();
    const auto cpu = open_voxelizer(Backend::cpu, setup).value();
    Sweep sweep;
    sweep.times_ns = {0};
    for (int i = 0; i < 500; ++i) sweep.returns.push_back({0.02 * i, 3 - 0.01 * i, 0.1, 0});
    const std::vector<Pose> poses(1);
    const Grid grid = grid_around(setup.map, Eigen::Vector3d::Zero());
    const auto found = cuda.backend->count(sweep, poses, grid);
    REQUIRE(found);
    CHECK(cuda.backend->filter_counts().used == cpu.backend->filter_counts().used + 500);
    CHECK(found->record_count == cpu.backend->count(sweep, poses, grid)->record_count);
  }
}

}  // namespace
}  // namespace gvom::test
