#include "tools/map/offline.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "services/common/odometry_file.hpp"
#include "services/common/stamps.hpp"
#include "services/ingest/source_options.hpp"

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

std::vector<std::string> explain(const RefusedMaps& refused) {
  std::vector<std::string> lines;
  const auto add = [&](std::uint64_t count, const char* why) {
    if (count > 0) lines.push_back(std::to_string(count) + " sweeps not mapped: " + why);
  };
  add(refused.duplicate, "there is a map of that time already (does the recording repeat itself?)");
  add(refused.too_old,
      "later ones had been mapped by then, and the window reaches no farther back (window.max_age_s; do "
      "times go back, or do the lidars' clocks differ?)");
  add(refused.before_jump, "from before a jump of the odometry, and the map had begun anew");
  return lines;
}

OfflineExpected<OfflineMapper> OfflineMapper::open(const services::VehicleConfig& config,
                                                   const std::string& odometry, bool deskew) {
  OfflineMapper mapper;
  mapper.deskew_ = deskew;
  if (auto added = mapper.add_fusion(config); !added) return tl::unexpected(added.error());
  if (auto added = mapper.add_odometry(config.odometry, odometry); !added)
    return tl::unexpected(added.error());
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

OfflineExpected<void> OfflineMapper::add_odometry(services::OdometryConfig config,
                                                  const std::string& odometry) {
  std::vector<StampedPose> poses{{kLongAgo_ns, {}}, {-kLongAgo_ns, {}}};
  if (odometry == "static") {
    config.max_gap_s = std::numeric_limits<double>::infinity();
  } else {
    auto recorded = services::read_odometry_source(odometry, warnings_);
    if (!recorded) return bad_data(recorded.error());
    poses = std::move(*recorded);
  }
  using ingest::OdometryIntake;
  odometry_ = std::make_unique<OdometryIntake>(config, OdometryIntake::Sweeps::recorded, poses.size());
  for (const StampedPose& pose : poses) {
    const ingest::Taken taken = odometry_->take({pose}, 0);
    if (taken == ingest::Taken::not_a_pose)
      return bad_data(odometry + ": a pose is too far away to be mapped");
    if (taken == ingest::Taken::jump)
      warnings_.push_back(odometry + ": has jumped at " + services::stamp_text(pose.stamp_ns) +
                          " s (odometry.max_speed_mps is exceeded): the map begins anew there");
  }
  odometry_->take({poses.back(), 0, true}, 0);
  return {};
}

OfflineExpected<void> OfflineMapper::add_lidar(const services::VehicleConfig& config,
                                               const services::LidarConfig& lidar) {
  const auto max_returns = static_cast<std::size_t>(lidar.max_returns);
  auto source = ingest::open_source(lidar.source, ingest::source_options(lidar));
  if (!source) return bad_data("lidar " + lidar.name + ": " + source.error().what);
  if (const auto lack = ingest::lack_of_room(lidar.name, max_returns, **source); !lack.empty())
    return bad_data(lack);
  if ((*source)->is_live()) return bad_data("lidar " + lidar.name + ": " + lidar.source + " is live");
  auto opened = open_voxelizer(lidar.backend,
                               {config.mapper.map, lidar.geometry, config.mapper.vehicle, max_returns, {}});
  if (!opened) return unavailable("lidars." + lidar.name + ".backend cuda: " + opened.error().what);
  Lidar added;
  added.name = lidar.name;
  added.source = std::move(*source);
  added.backend = {opened->name, opened->details};
  added.mapper = std::make_unique<SweepMapper>(config.mapper.map, std::move(opened->backend));
  added.ground = std::make_unique<ingest::GroundCheck>(lidar.geometry, config.mapper.vehicle);
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
  const ingest::Placement placement = odometry_->judge(lidar.sweep, 0, 0);
  if (placement.when != ingest::Placement::When::now) {
    lidar.losses.count(placement.why, lidar.sweep.stamp_ns);
    return false;
  }
  const auto shape = lidar.mapper->count(lidar.sweep, odometry_->poses());
  if (!shape) return unavailable(shape.error().what);
  lidar.losses.count_placed(lidar.sweep.stamp_ns);
  auto map = std::make_unique<BrickMapStorage>();
  if (const auto written = lidar.mapper->write(map->resize(*shape)); !written)
    return unavailable(written.error().what);
  const auto fused = fuse(index, std::move(map));
  if (!fused || !*fused) return fused;
  lidar.ground->see(lidar.sweep, lidar.mapper->T_odom_base().translation_m);
  mapped = {lidar.name, lidar.sweep.stamp_ns, lidar.sweep.complete, lidar.mapper->filter_counts()};
  return true;
}

// As gvom-fusion does: after a jump the window begins anew.
OfflineExpected<bool> OfflineMapper::fuse(std::size_t index, std::unique_ptr<BrickMapStorage> map) {
  Lidar& lidar = lidars_[index];
  const std::int64_t stamp_ns = lidar.sweep.stamp_ns;
  if (const std::int64_t jump_ns = odometry_->poses().jump_before(stamp_ns); jump_ns > jump_ns_) {
    jump_ns_ = jump_ns;
    fuser_->reset();
    window_.clear();
  }
  if (jump_ns_ != 0 && stamp_ns < jump_ns_) return ++lidar.refused.before_jump, false;
  const std::uint64_t token = next_token_++;
  const BrickMapView view = map->view(lidar.mapper->grid(), stamp_ns, lidar.mapper->T_odom_base());
  window_.emplace(token, std::move(map));
  const auto result = fuser_->add({view, static_cast<int>(index), token});
  if (!result) return unavailable(result.error().what);
  if (*result != AddResult::added) {
    window_.erase(token);
    ++(*result == AddResult::duplicate ? lidar.refused.duplicate : lidar.refused.too_old);
    return false;
  }
  for (const WindowMap& left : fuser_->window().left()) window_.erase(left.token);
  return true;
}

std::uint64_t OfflineMapper::sweeps_without_odometry() const {
  std::uint64_t sum = 0;
  for (const Lidar& lidar : lidars_) sum += lidar.losses.all();
  return sum;
}

std::uint64_t OfflineMapper::maps_refused() const {
  std::uint64_t sum = 0;
  for (const Lidar& lidar : lidars_) sum += lidar.refused.all();
  return sum;
}

/// Who has the oldest sweep. One that is after all odometry is never mapped, and holds nobody back.
std::optional<std::size_t> OfflineMapper::whose_turn() const {
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < lidars_.size(); ++i) {
    const std::int64_t stamp_ns = lidars_[i].sweep.stamp_ns;
    if (lidars_[i].ended) continue;
    if (odometry_->span() && stamp_ns > odometry_->span()->last_ns) return i;
    if (!first || stamp_ns < lidars_[*first].sweep.stamp_ns) first = i;
  }
  return first;
}

OfflineExpected<bool> OfflineMapper::next(MappedSweep& mapped) {
  for (;;) {
    if (error_) return tl::unexpected(*std::exchange(error_, std::nullopt));
    const auto turn = whose_turn();
    if (!turn) return false;
    const auto fused = map_sweep(*turn, mapped);
    if (!fused) return fused;
    if (auto advanced = advance(lidars_[*turn]); !advanced) error_ = advanced.error();
    if (*fused) return true;
  }
}

}  // namespace gvom::tools
