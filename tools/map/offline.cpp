#include "tools/map/offline.hpp"

#include <algorithm>
#include <utility>

#include "services/common/odometry_file.hpp"

namespace gvom::tools {

namespace {

// Far enough apart for every stamp, near enough for their difference to be an int64.
constexpr std::int64_t kLongAgo_ns = -4'000'000'000'000'000'000;

tl::unexpected<OfflineError> bad_data(std::string what) {
  return tl::make_unexpected(OfflineError{services::ExitCode::bad_data, std::move(what)});
}

tl::unexpected<OfflineError> unavailable(std::string what) {
  return tl::make_unexpected(OfflineError{services::ExitCode::unavailable, std::move(what)});
}

}  // namespace

OfflineExpected<OfflineMapper> OfflineMapper::open(const services::VehicleConfig& config,
                                                   const std::string& odometry, bool deskew) {
  OfflineMapper mapper;
  mapper.deskew_ = deskew;
  if (auto added = mapper.add_fusion(config); !added) return tl::unexpected(added.error());
  if (auto added = mapper.add_odometry(odometry); !added) return tl::unexpected(added.error());
  for (const services::LidarConfig& lidar : config.lidars) {
    if (lidar.source.empty()) continue;
    if (auto added = mapper.add_lidar(config, lidar); !added) return tl::unexpected(added.error());
  }
  if (mapper.lidars_.empty()) return bad_data("no lidar has a source: give --source NAME=URI");
  return mapper;
}

OfflineExpected<void> OfflineMapper::add_fusion(const services::VehicleConfig& config) {
  FusionSetup setup;
  setup.config = config.mapper;
  setup.lidars = static_cast<int>(config.lidars.size());
  for (const services::LidarConfig& lidar : config.lidars)
    setup.max_returns = std::max(setup.max_returns, static_cast<std::size_t>(lidar.max_returns));
  auto opened = open_fusion(config.fusion.backend, setup);
  if (!opened) return unavailable("fusion.backend cuda: " + opened.error().what);
  fusion_backend_ = {opened->name, opened->details};
  fuser_ = std::make_unique<MapFuser>(std::move(opened->backend));
  return {};
}

OfflineExpected<void> OfflineMapper::add_odometry(const std::string& odometry) {
  std::vector<StampedPose> poses{{kLongAgo_ns, {}}, {-kLongAgo_ns, {}}};
  if (odometry != "static") {
    auto recorded = services::read_odometry_source(odometry, warnings_);
    if (!recorded) return bad_data(recorded.error());
    poses = std::move(*recorded);
  }
  odometry_ = std::make_unique<OdometryBuffer>(poses.size());
  for (const StampedPose& pose : poses)
    if (odometry_->add(pose) != OdometryBuffer::Add::added)
      return bad_data(odometry + ": a pose is too far away to be mapped");
  return {};
}

OfflineExpected<void> OfflineMapper::add_lidar(const services::VehicleConfig& config,
                                               const services::LidarConfig& lidar) {
  const auto max_returns = static_cast<std::size_t>(lidar.max_returns);
  auto source = ingest::open_source(lidar.source, {lidar.min_sweep_fraction, max_returns});
  if (!source) return bad_data("lidar " + lidar.name + ": " + source.error().what);
  if ((*source)->is_live()) return bad_data("lidar " + lidar.name + ": " + lidar.source + " is live");
  auto opened = open_voxelizer(lidar.backend,
                               {config.mapper.map, lidar.geometry, config.mapper.vehicle, max_returns, {}});
  if (!opened) return unavailable("lidars." + lidar.name + ".backend cuda: " + opened.error().what);
  Lidar added;
  added.name = lidar.name;
  added.source = std::move(*source);
  added.backend = {opened->name, opened->details};
  added.mapper = std::make_unique<SweepMapper>(config.mapper.map, std::move(opened->backend));
  lidars_.push_back(std::move(added));
  if (auto first = advance(lidars_.back()); !first) return tl::unexpected(first.error());
  return {};
}

OfflineExpected<void> OfflineMapper::advance(Lidar& lidar) {
  const auto event = lidar.source->next(lidar.sweep, std::chrono::milliseconds(0));
  lidar.ended = !event || *event == ingest::SourceEvent::kEnd;
  if (!event) return bad_data("lidar " + lidar.name + ": " + event.error());
  if (!deskew_) std::fill(lidar.sweep.times_ns.begin(), lidar.sweep.times_ns.end(), lidar.sweep.stamp_ns);
  return {};
}

// False if the sweep did not become part of the map.
OfflineExpected<bool> OfflineMapper::map_sweep(std::size_t index, MappedSweep& mapped) {
  Lidar& lidar = lidars_[index];
  const auto shape = lidar.mapper->count(lidar.sweep, *odometry_);
  if (!shape && shape.error().reason == SweepError::Reason::device) return unavailable(shape.error().what);
  if (!shape) return ++without_odometry_, false;
  auto map = std::make_unique<BrickMapStorage>();
  if (const auto written = lidar.mapper->write(map->resize(*shape)); !written)
    return unavailable(written.error().what);
  const std::uint64_t token = next_token_++;
  const BrickMapView view =
      map->view(lidar.mapper->grid(), lidar.sweep.stamp_ns, lidar.mapper->T_odom_base());
  window_.emplace(token, std::move(map));
  const auto result = fuser_->add({view, static_cast<int>(index), token});
  if (!result) return unavailable(result.error().what);
  if (*result != AddResult::added) {
    window_.erase(token);
    return ++refused_, false;
  }
  for (const WindowMap& left : fuser_->window().left()) window_.erase(left.token);
  mapped = {lidar.name, lidar.sweep.stamp_ns, lidar.sweep.complete, lidar.mapper->filter_counts()};
  return true;
}

OfflineExpected<bool> OfflineMapper::next(MappedSweep& mapped) {
  for (;;) {
    if (error_) return tl::unexpected(*std::exchange(error_, std::nullopt));
    std::size_t first = lidars_.size();
    for (std::size_t i = 0; i < lidars_.size(); ++i) {
      if (lidars_[i].ended) continue;
      if (first == lidars_.size() || lidars_[i].sweep.stamp_ns < lidars_[first].sweep.stamp_ns) first = i;
    }
    if (first == lidars_.size()) return false;
    const auto fused = map_sweep(first, mapped);
    if (!fused) return fused;
    if (auto advanced = advance(lidars_[first]); !advanced) error_ = advanced.error();
    if (*fused) return true;
  }
}

}  // namespace gvom::tools
