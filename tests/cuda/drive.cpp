#include "tests/cuda/drive.hpp"

#include <cmath>
#include <utility>

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

}  // namespace

Drive::Drive() : segment_(std::size_t{16} << 20), layers_(segment_.loan_layers(config().map.size_xy)) {}

DeviceExpected<std::unique_ptr<Drive>> Drive::open(Backend backend) {
  std::unique_ptr<Drive> drive(new Drive);
  auto fusion = open_fusion(backend, {config(), 1, kReturns, drive->segment_.memory()});
  if (!fusion) return tl::make_unexpected(fusion.error());
  auto voxelizer =
      open_voxelizer(backend, {config().map, {}, config().vehicle, kReturns, drive->segment_.memory()});
  if (!voxelizer) return tl::make_unexpected(voxelizer.error());
  drive->mapper_ = std::make_unique<SweepMapper>(config().map, std::move(voxelizer->backend));
  drive->fuser_ = std::make_unique<MapFuser>(std::move(fusion->backend));
  return drive;
}

Pose Drive::pose() const {
  const double angle = static_cast<double>(steps_) * 0.05;
  return {{20 * std::sin(angle), 20 * std::cos(angle), std::sin(angle * 3)},
          Eigen::Quaterniond(Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitZ()))};
}

bool Drive::fail(const std::string& what) {
  failure_ = what;
  return false;
}

bool Drive::step() {
  sweep_.clear();
  sweep_.stamp_ns = static_cast<std::int64_t>(++steps_) * kPeriod_ns;
  sweep_.times_ns = {sweep_.stamp_ns};
  for (std::uint32_t i = 0; i < kReturns; ++i)
    sweep_.returns.push_back(
        {random_.uniform(-15, 15), random_.uniform(-15, 15), random_.uniform(-1.5, 2), 0});
  odometry_.add({sweep_.stamp_ns, pose()});
  const auto shape = mapper_->count(sweep_, odometry_);
  if (!shape) return fail(shape.error().what);
  BrickMapView view{mapper_->grid(), sweep_.stamp_ns, record_of(mapper_->T_odom_base()), {}};
  const BrickMapArrays chunk = segment_.loan_map(*shape, view);
  if (const auto written = mapper_->write(chunk); !written) return fail(written.error().what);
  const auto result = fuser_->add({view, 0, steps_});
  if (!result) return fail(result.error().what);
  for (const WindowMap& left : fuser_->window().left()) segment_.give_back(left.view.directory);
  if (const auto made = fuser_->make_layers(layers_); !made) return fail(made.error().what);
  return true;
}

}  // namespace gvom::test
