// What is taken from the map is missing in it: small cases with computed answers.
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "tools/drive/ablation.hpp"
#include "tools/drive/paper_rules.hpp"

using namespace gvom;
using namespace gvom::driving;

namespace {

constexpr double kSensor_m = 2.0;  // above base_link, which is on the ground
constexpr std::int64_t kTurn_ns = 100'000'000;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// One lidar that sees whatever it is told.
Rig small_rig() {
  Rig rig;
  rig.mapping.mapper.map.size_xy = 64;
  rig.mapping.mapper.map.size_z = 32;
  rig.mapping.mapper.vehicle.radius_m = 0;
  LidarGeometry lidar;
  lidar.T_base_sensor.translation().z() = kSensor_m;
  rig.mapping.lidars.push_back(lidar);
  return rig;
}

/// Returns at places relative to base_link, all at a time before the stamp.
Sweep sweep_of(const std::vector<Eigen::Vector3d>& places_m, std::int64_t stamp_ns,
               std::int64_t before_ns = 0) {
  Sweep sweep;
  sweep.stamp_ns = stamp_ns;
  sweep.times_ns = {stamp_ns - before_ns};
  for (const Eigen::Vector3d& place : places_m)
    sweep.returns.push_back({place.x(), place.y(), place.z() - kSensor_m, 0});
  return sweep;
}

/// A vehicle that drives along x from the origin, at 0 s, for 10 s.
OdometryBuffer odometry_at(double speed_mps,
                           const Eigen::Quaterniond& attitude = Eigen::Quaterniond::Identity()) {
  OdometryBuffer odometry;
  for (int i = 0; i <= 100; ++i) odometry.add({i * kTurn_ns + 1, {{speed_mps * i * 0.1, 0, 0}, attitude}});
  return odometry;
}

struct Mapped {
  explicit Mapped(Ablation ablation, const Rig& rig = small_rig())
      : ablation_(ablation),
        rig_(*ablated(rig, ablation)),
        pipeline_(rig_.mapping, 1000, make_fusion(rig_.mapping.mapper, ablation)) {}

  void add(Sweep sweep, const OdometryBuffer& odometry) {
    if (ablation_ == Ablation::deskew_off) forget_times(sweep);
    REQUIRE(pipeline_.add(0, sweep, odometry));
  }

  /// Of the column that holds a place.
  struct Column {
    float height_m;
    std::uint8_t flags;
  };
  Column at(double x_m, double y_m) {
    const LayerArrays& layers = pipeline_.make_layers();
    const Grid& grid = pipeline_.grid();
    const auto place = [&](double along_m, std::size_t axis) {
      return static_cast<int>(std::floor(along_m / grid.resolution_m[axis])) - grid.origin[axis];
    };
    const int i = place(y_m, 1) * grid.size[0] + place(x_m, 0);
    return {layers.height[i], layers.flags[i]};
  }

 private:
  Ablation ablation_;
  Rig rig_;
  mapping::Pipeline pipeline_;
};

/// Layers of 16 x 16 columns with a height of 0.
struct Heights {
  Heights() : storage(config()), layers(storage.arrays()) { std::fill_n(layers.height, 256, 0.0F); }

  static MapConfig config() {
    MapConfig map;
    map.size_xy = 16;
    return map;
  }
  void fill(int from_x, int to_x, float height_m) {
    for (int y = 0; y < 16; ++y)
      for (int x = from_x; x <= to_x; ++x) layers.height[y * 16 + x] = height_m;
  }

  mapping::LayerStorage storage;
  LayerArrays layers;
};

}  // namespace

TEST_CASE("each ablation has a name, and no other name is one") {
  for (const Ablation ablation : kAblations) CHECK(find_ablation(name_of(ablation)) == ablation);
  CHECK_FALSE(find_ablation("paper-R12"));
}

TEST_CASE("without deskewing a return lies where the vehicle had not yet been") {
  // At 5 m/s the vehicle is at 5 m at the stamp, 1 s, and at 4.5 m when the return was measured, 10.2 m
  // ahead.
  const OdometryBuffer odometry = odometry_at(5);
  const Sweep sweep = sweep_of({{10.2, 0.2, 0}}, kSecond_ns + 1, kTurn_ns);
  Mapped ours(Ablation::none), without(Ablation::deskew_off);
  ours.add(sweep, odometry);
  without.add(sweep, odometry);
  CHECK(std::isfinite(ours.at(14.7, 0.2).height_m));
  CHECK(std::isnan(ours.at(15.2, 0.2).height_m));
  CHECK(std::isnan(without.at(14.7, 0.2).height_m));
  CHECK(std::isfinite(without.at(15.2, 0.2).height_m));
}

TEST_CASE("without memory what left the window is unknown") {
  const OdometryBuffer odometry = odometry_at(0);
  for (const Ablation ablation : {Ablation::none, Ablation::memory_off}) {
    Mapped map(ablation);
    map.add(sweep_of({{4.2, 0.2, 0.1}}, kSecond_ns), odometry);
    map.add(sweep_of({{-4.2, 0.2, 0.1}}, 4 * kSecond_ns), odometry);  // the window reaches 2 s back
    CHECK(std::isfinite(map.at(4.2, 0.2).height_m) == (ablation == Ablation::none));
    CHECK(std::isfinite(map.at(-4.2, 0.2).height_m));
  }
}

TEST_CASE("all lidars but the first can be silent, if there are others") {
  Rig rig = small_rig();
  CHECK_FALSE(ablated(rig, Ablation::one_lidar));
  rig.mapping.lidars.push_back(rig.mapping.lidars.front());
  rig.mapping.lidars.front().T_base_sensor.translation().x() = 0.7;
  const auto one = ablated(rig, Ablation::one_lidar);
  REQUIRE(one);
  REQUIRE(one->mapping.lidars.size() == 1);
  CHECK(one->mapping.lidars.front().T_base_sensor.translation().x() == 0.7);
}

TEST_CASE("by the paper's R9 a crown that rays pass below is ground, and assumed ground is level") {
  // From 2 m up, rays to the ground at 10.2 m are 1 m above it below the crown at 5 m.
  const std::vector<Eigen::Vector3d> places_m(6, {10.2, 0.2, 0});
  Sweep sweep = sweep_of(places_m, kSecond_ns);
  sweep.returns.push_back({5.0, 0.1, 1.9 - kSensor_m, 0});
  Rig rig = small_rig();
  rig.mapping.mapper.vehicle.radius_m = 3;
  // The front down by 0.1 rad. That turns the sweep, too: only assumed ground behind is asked for.
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond down(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()));
  Mapped ours(Ablation::none, rig), paper(Ablation::paper_r9, rig);
  Mapped ours_down(Ablation::none, rig), paper_down(Ablation::paper_r9, rig);
  for (Mapped* map : {&ours, &paper}) map->add(sweep, odometry_at(0, level));
  for (Mapped* map : {&ours_down, &paper_down}) map->add(sweep, odometry_at(0, down));
  CHECK_FALSE(ours.at(5.0, 0.1).height_m > 0.5F);
  CHECK(paper.at(5.0, 0.1).height_m == Approx(1.9));
  CHECK(paper.at(10.2, 0.2).height_m == Approx(0).margin(1e-6));
  CHECK(ours_down.at(-2.2, 0.2).height_m == Approx(2.2 * std::tan(0.1)).margin(0.01));
  CHECK(paper_down.at(-2.2, 0.2).height_m == 0);
  CHECK((paper_down.at(-2.2, 0.2).flags & kAssumed) != 0);
}

TEST_CASE("by the paper's R13 unknown ground between heights that differ is a hole") {
  Heights map;
  map.fill(6, 9, NAN);
  map.fill(10, 15, -1.0F);
  LayersConfig config;  // 0.5 m
  PaperHoles holes(16);
  holes.find(config, map.layers);
  for (int x = 0; x < 16; ++x) {
    const bool unknown = x >= 6 && x <= 9;
    CHECK(map.layers.negative_delta[8 * 16 + x] == (unknown ? 1.0F : 0.0F));
    CHECK((map.layers.flags[8 * 16 + x] & kNegative) == (unknown ? kNegative : 0));
  }
}

TEST_CASE("the paper's R13 searches as far as it is told, in cones, and compares heights alone") {
  Heights map;
  std::fill_n(map.layers.height, 256, NAN);
  map.layers.height[8 * 16 + 12] = 1.0F;  // 4 columns along x from (8, 8)
  map.layers.height[5 * 16 + 6] = 0.0F;   // 2 against x, 3 against y: in the cone along y only
  LayersConfig config;
  PaperHoles holes(16);
  config.search_distance = 3;
  holes.find(config, map.layers);
  CHECK(map.layers.negative_delta[8 * 16 + 8] == 0);  // one height is no difference
  config.search_distance = 4;
  holes.find(config, map.layers);
  CHECK(map.layers.negative_delta[8 * 16 + 8] == 1);
  map.layers.height[5 * 16 + 9] = 0.8F;  // nearer to the axis in the same row
  holes.find(config, map.layers);
  CHECK(map.layers.negative_delta[8 * 16 + 8] == Approx(0.2));
}
