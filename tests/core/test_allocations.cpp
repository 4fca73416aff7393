// After its first maps the pipeline allocates nothing.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/mapper.hpp"
#include "tests/core/random.hpp"
#include "tests/oracle/layers.hpp"
#include "tests/support/allocations.hpp"

namespace gvom::test {
namespace {

constexpr std::uint32_t kReturns = 300;
constexpr std::int64_t kPeriod_ns = 50'000'000;

MapperConfig config() {
  MapperConfig config;
  config.map = {0.4, 0.4, 64, 32};
  config.window = {4, 2.0};
  return config;
}

// Room for the largest map, as a chunk of shared memory has.
struct Chunk {
  std::vector<std::int32_t> directory, lookup;
  std::vector<std::uint64_t> columns;
  std::vector<float> lowest_ray_m;
  std::vector<VoxelRecord> records;

  explicit Chunk(const Grid& grid)
      : directory(grid.brick_slots()),
        lookup(directory.size() * kBrickCells),
        columns(directory.size()),
        lowest_ray_m(grid.columns()),
        records(kReturns) {}
  BrickMapArrays arrays() {
    return {directory.data(), lookup.data(), columns.data(), lowest_ray_m.data(), records.data()};
  }
};

// One lidar's drive in a circle; every sweep is counted, written, fused and made into layers.
class Drive {
 public:
  Drive() {
    for (int i = 0; i < 6; ++i) chunks_.emplace_back(grid_around(config().map, Eigen::Vector3d::Zero()));
    sweep_.returns.reserve(kReturns);
    sweep_.times_ns.reserve(10);
  }

  void step() {
    prepare_sweep();
    const std::int64_t before = sweep_.times_ns.front();
    odometry_.add({before, pose()});
    ++steps_;
    odometry_.add({sweep_.stamp_ns, pose()});
    const auto shape = mapper_.count(sweep_, odometry_);
    Chunk& chunk = chunks_[steps_ % chunks_.size()];
    failures_ += !mapper_.write(chunk.arrays());
    const BrickMapView view{mapper_.grid(),
                            sweep_.stamp_ns,
                            record_of(mapper_.T_odom_base()),
                            *shape,
                            chunk.directory.data(),
                            chunk.lookup.data(),
                            chunk.columns.data(),
                            chunk.lowest_ray_m.data(),
                            chunk.records.data()};
    added_ += fuser_.add({view, 0, steps_}).value() == AddResult::added;
    failures_ += !fuser_.make_layers(layers_.arrays());
  }

  [[nodiscard]] std::size_t added() const { return added_; }
  [[nodiscard]] int failures() const { return failures_; }

 private:
  [[nodiscard]] Pose pose() const {
    const double angle = static_cast<double>(steps_) * 0.05;
    return {{20 * std::sin(angle), 20 * std::cos(angle), std::sin(angle * 3)},
            Eigen::Quaterniond(Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitZ()))};
  }

  void prepare_sweep() {
    sweep_.clear();
    sweep_.stamp_ns = static_cast<std::int64_t>(steps_ + 1) * kPeriod_ns;
    for (int i = 9; i >= 0; --i) sweep_.times_ns.push_back(sweep_.stamp_ns - i * 4'000'000);
    for (std::uint32_t i = 0; i < kReturns; ++i)
      sweep_.returns.push_back(
          {random_.uniform(-15, 15), random_.uniform(-15, 15), random_.uniform(-1.5, 2), i * 10 / kReturns});
  }

  Random random_{5};
  std::size_t steps_ = 0;
  std::size_t added_ = 0;
  int failures_ = 0;
  Sweep sweep_;
  OdometryBuffer odometry_;
  SweepMapper mapper_{config(), {}, kReturns};
  MapFuser fuser_{config()};
  oracle::Layers layers_{config().map.size_xy};
  std::vector<Chunk> chunks_;
};

TEST_CASE("A thousand sweeps after the first few allocate nothing") {
  if (!counts_allocations()) return;
  Drive drive;
  for (int i = 0; i < 20; ++i) drive.step();
  const std::uint64_t before = allocations();
  for (int i = 0; i < 1000; ++i) drive.step();
  const std::uint64_t after = allocations();
  CHECK(after - before == 0);
  CHECK(drive.added() == 1020);
  CHECK(drive.failures() == 0);
}

TEST_CASE("The count of allocations counts") {
  if (!counts_allocations()) return;
  const std::uint64_t before = allocations();
  const std::vector<int> some(1000);
  CHECK(allocations() > before);
  CHECK(some.size() == 1000);
}

}  // namespace
}  // namespace gvom::test
