#include "services/fusion/fusion_node.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "ipc/text.hpp"
#include "services/common/bus/core_types.hpp"
#include "services/common/config_file.hpp"
#include "services/fusion/missing.hpp"

namespace gvom::fusion {

namespace {

constexpr std::chrono::milliseconds kLongestWait{100};
constexpr std::int64_t kProgressPeriod_ns = 250'000'000;  // also while idle, so that a replay sees us
constexpr std::int64_t kStale_ns = 1'000'000'000;
constexpr std::int64_t kBadMapTold_ns = 2'000'000'000;

std::int64_t period_ns(double rate_hz) {
  return static_cast<std::int64_t>(1e9 / rate_hz);
}

}  // namespace

FusionNode::FusionNode(const services::VehicleConfig& config, ipc::Runtime& runtime, Bus& bus,
                       services::Lifecycle& lifecycle, OpenBackend<FusionBackend> backend)
    : config_(config),
      bus_(bus),
      lifecycle_(lifecycle),
      broker_(runtime),
      health_(runtime.name(), services::config_hash(config)),
      counters_(health_),
      fuser_(std::move(backend.backend)) {
  health_.set_backend(backend.name, backend.details);
  lifecycle_.on_stop([this] { bus_.waiter.wake(); });
}

FusionNode::~FusionNode() {
  lifecycle_.on_stop({});
}

services::ExitCode FusionNode::run() {
  services::notify_ready();
  while (!lifecycle_.stopping()) {
    fuse_arrived();
    const std::int64_t now_ns = ipc::monotonic_ns();
    if (config_.fusion.rate_hz > 0 && tick_due(now_ns)) publish_layers();
    publish_voxels();
    if (failure_) break;
    publish_progress();
    publish_health();
    broker_.check();
    auto timeout = kLongestWait;
    if (config_.fusion.rate_hz > 0 && fresh_)
      timeout = std::clamp(std::chrono::milliseconds((next_tick_ns_ - now_ns) / 1'000'000 + 1),
                           std::chrono::milliseconds(0), kLongestWait);
    bus_.waiter.wait(timeout);
  }
  services::notify_stopping();
  health_.set_state(failure_ ? ipc::HealthState::failed : ipc::HealthState::stopping, failure_.value_or(""));
  send_health(ipc::monotonic_ns());
  spdlog::info("{} maps fused, {} layers published", counters_.maps_fused, counters_.layers_out);
  broker_.leave_if_gone();
  return failure_ ? services::ExitCode::try_again : services::ExitCode::ok;
}

void FusionNode::fuse_arrived() {
  // A few at a time: maps that come faster than they are fused must not keep it from telling its health.
  for (std::size_t i = 0; i < bus_.inbox.lidars().size(); ++i) {
    const auto map = bus_.inbox.take();
    if (!map) break;
    fuse(*map);
    if (failure_) return;
    if (config_.fusion.rate_hz <= 0 ? fresh_ : tick_due(ipc::monotonic_ns())) publish_layers();
    publish_progress();
    if (lifecycle_.stopping() || failure_) return;
  }
  if (const auto refusal = bus_.inbox.new_refusal()) spdlog::error("{}", *refusal);
}

void FusionNode::fuse(const ArrivedMap& map) {
  const ipc::BrickMap& header = map.sample->header();
  ++counters_.maps_in;
  progress_news_ = true;
  if (const auto sound = map.sample->validate_deep(); !sound) return refuse(map, sound.error());
  if (header.header.epoch > epoch_) begin_epoch(header.header.epoch);
  if (header.header.epoch < epoch_) {
    ++counters_.drop_map_old_epoch;
    return bus_.inbox.release(map.token);
  }
  if (header.odometry_jump_ns > jump_ns_) begin_after_jump(header.odometry_jump_ns);
  if (jump_ns_ != 0 && header.header.stamp_ns < jump_ns_) {
    ++counters_.drop_map_before_jump;
    return bus_.inbox.release(map.token);
  }
  const std::int64_t begin_ns = ipc::monotonic_ns();
  const auto result = fuser_.add({services::view_of(*map.sample), map.lidar, map.token});
  if (!result) {  // the device may still read the map: it is not released
    ++counters_.drop_map_backend_failed;
    return fail(result.error());
  }
  if (*result != AddResult::added) return refuse(map, *result);
  fused_ns_ = ipc::monotonic_ns();
  counters_.fuse.record_ns(fused_ns_ - begin_ns);
  ++counters_.maps_fused;
  fresh_ = true;
  if (fuser_.window().maps().front().token == map.token) newest_ = header;
  for (const WindowMap& left : fuser_.window().left()) bus_.inbox.release(left.token);
}

void FusionNode::begin_epoch(std::uint64_t epoch) {
  if (epoch_ != 0) {
    ++counters_.epochs;
    spdlog::info("the odometry's clock begins anew: the window is emptied");
  }
  epoch_ = epoch;
  jump_ns_ = 0;
  empty_window();
}

void FusionNode::begin_after_jump(std::int64_t stamp_ns) {
  ++counters_.odometry_jumps;
  spdlog::warn("the odometry has jumped: the window is emptied");
  jump_ns_ = stamp_ns;
  empty_window();
}

void FusionNode::empty_window() {
  fuser_.reset();
  fresh_ = false;
  voxels_fresh_ = false;
  for (const WindowMap& left : fuser_.window().left()) bus_.inbox.release(left.token);
}

/// Before its epoch or jump is looked at: nothing of such a map is believed.
void FusionNode::refuse(const ArrivedMap& map, const ipc::MapFault& fault) {
  counters_.count_drop(fault.part);
  bad_map_ = "lidar " + bus_.inbox.lidars()[static_cast<std::size_t>(map.lidar)].name + ": " + fault.why;
  bad_map_ns_ = ipc::monotonic_ns();
  log_drops_(spdlog::level::err, "{}", bad_map_);
  bus_.inbox.release(map.token);
}

void FusionNode::refuse(const ArrivedMap& map, AddResult result) {
  counters_.count_drop(result);
  if (result == AddResult::wrong_grid) {
    log_drops_(spdlog::level::err,
               "a map of another grid came: do all processes have the same configuration?");
  }
  bus_.inbox.release(map.token);
}

void FusionNode::fail(const DeviceError& error) {
  failure_ = error.what;
  fresh_ = false;
  voxels_fresh_ = false;
  spdlog::critical("{}: leaving, to be started again", error.what);
}

bool FusionNode::tick_due(std::int64_t now_ns) const {
  return fresh_ && now_ns >= next_tick_ns_;
}

void FusionNode::publish_layers() {
  const std::int64_t begin_ns = ipc::monotonic_ns();
  if (config_.fusion.rate_hz > 0)
    next_tick_ns_ = std::max(next_tick_ns_ + period_ns(config_.fusion.rate_hz), begin_ns);
  fresh_ = false;
  const LayerMoment moment = fuser_.moment();
  auto writer = bus_.layers.loan(moment.grid.size[0], moment.grid.size[2]);
  if (!writer) {
    ++counters_.drop_layers_no_chunk;
    log_drops_(spdlog::level::err, "layers are lost: {}", writer.error().message);
    return;
  }
  if (const auto made = fuser_.make_layers(services::arrays_of(*writer)); !made) return fail(made.error());
  record_costs();
  ipc::Layers& header = writer->header();
  services::set_frame(moment.grid, moment.T_odom_base, header);
  fill_lidars(header);
  header.mono_received_ns = newest_.mono_received_ns;
  header.suspended_ns = newest_.suspended_ns;
  header.mono_mapped_ns = newest_.mono_mapped_ns;
  header.mono_map_published_ns = newest_.mono_published_ns;
  header.mono_fused_ns = fused_ns_;
  bus_.layers.publish(std::move(*writer), moment.stamp_ns, epoch_);
  last_layers_ns_ = ipc::monotonic_ns();
  counters_.make_layers.record_ns(last_layers_ns_ - begin_ns);
  counters_.received_to_layers.record_ns(last_layers_ns_ - newest_.mono_received_ns);
  ++counters_.layers_out;
  health_.count_product();
  services::notify_watchdog();
  voxels_fresh_ = true;
  publish_voxels();
}

void FusionNode::record_costs() {
  const auto costs = fuser_.backend().last_costs();
  if (!costs) return;
  if (!device_stages_) device_stages_.emplace(health_);
  device_stages_->record(*costs);
}

void FusionNode::fill_lidars(ipc::Layers& header) const {
  const Window& window = fuser_.window();
  const std::int64_t missing_after_ns = std::llround(config_.fusion.missing_after_s * 1e9);
  header.maps_in_window = static_cast<std::uint32_t>(window.maps().size());
  header.lidar_count = static_cast<std::uint32_t>(bus_.inbox.lidars().size());
  for (std::size_t i = 0; i < bus_.inbox.lidars().size(); ++i) {
    const MapInbox::Lidar& lidar = bus_.inbox.lidars()[i];
    ipc::LidarStatus& status = header.lidars[i];
    ipc::set_text(status.name, lidar.name);
    status.newest_stamp_ns = lidar.newest_stamp_ns;
    status.maps_in_window = static_cast<std::uint32_t>(window.count(static_cast<int>(i)));
    status.missing = is_missing(window, static_cast<int>(i), missing_after_ns) ? 1 : 0;
    status.maps_received = lidar.maps.counters().received;
    status.maps_lost = lidar.maps.counters().lost;
    status.columns_seen_fraction = lidar.columns_seen_fraction;
  }
}

void FusionNode::publish_voxels() {
  const std::int64_t now_ns = ipc::monotonic_ns();
  if (config_.fusion.voxel_rate_hz <= 0 || !voxels_fresh_ || now_ns < next_voxels_ns_) return;
  if (!bus_.voxels.has_subscribers()) return;
  voxels_fresh_ = false;
  next_voxels_ns_ = now_ns + period_ns(config_.fusion.voxel_rate_hz);
  const auto shape = fuser_.count_voxels();
  if (!shape) return fail(shape.error());
  auto writer = bus_.voxels.loan(shape->brick_slots, shape->brick_count, shape->record_count);
  if (!writer) {
    ++counters_.drop_voxels_no_chunk;
    log_drops_(spdlog::level::err, "a voxel map is lost: {}", writer.error().message);
    return;
  }
  const LayerMoment moment = fuser_.moment();
  services::set_frame(moment.grid, moment.T_odom_base, writer->header());
  writer->header().columns_seen_fraction = 1;
  if (const auto written = fuser_.write_voxels(services::arrays_of(*writer)); !written)
    return fail(written.error());
  bus_.voxels.publish(std::move(*writer), moment.stamp_ns, epoch_);
  ++counters_.voxel_maps_out;
}

void FusionNode::publish_progress() {
  const std::int64_t now_ns = ipc::monotonic_ns();
  if (!progress_news_ && now_ns < next_progress_ns_) return;
  ipc::Progress progress{};
  ipc::set_text(progress.reader, "fusion");
  progress.lidar_count = static_cast<std::uint32_t>(bus_.inbox.lidars().size());
  for (std::size_t i = 0; i < bus_.inbox.lidars().size(); ++i) {
    ipc::set_text(progress.taken[i].lidar, bus_.inbox.lidars()[i].name);
    progress.taken[i].sequence = bus_.inbox.lidars()[i].taken_sequence;
  }
  if (!bus_.progress.publish(progress, newest_.header.stamp_ns, epoch_)) return;
  progress_news_ = false;
  next_progress_ns_ = now_ns + kProgressPeriod_ns;
}

void FusionNode::publish_health() {
  const std::int64_t now_ns = ipc::monotonic_ns();
  if (!health_.due(now_ns)) return;
  if (bad_map_ns_ != 0 && now_ns - bad_map_ns_ < kBadMapTold_ns)
    health_.set_state(ipc::HealthState::degraded, bad_map_);
  else if (last_layers_ns_ == 0)
    health_.set_state(ipc::HealthState::starting, "no maps yet");
  else if (now_ns - last_layers_ns_ < kStale_ns)
    health_.set_state(ipc::HealthState::ok);
  else
    health_.set_state(ipc::HealthState::degraded, "no maps: the layers are old");
  services::notify_watchdog();
  send_health(now_ns);
}

void FusionNode::send_health(std::int64_t now_ns) {
  counters_.maps_lost = 0;
  counters_.drop_map_refused = 0;
  for (const MapInbox::Lidar& lidar : bus_.inbox.lidars()) {
    counters_.maps_lost += lidar.maps.counters().lost;
    counters_.drop_map_refused += lidar.maps.counters().refused();
  }
  const ipc::Health& health = health_.take(now_ns);
  char status[128];
  std::snprintf(status, sizeof status, "%.1f layers/s, %s, %zu maps in the window", health.rate_hz,
                services::age_text(last_layers_ns_, health.mono_ns).data(), fuser_.window().maps().size());
  services::notify_status(status);
  if (!bus_.health.publish(health, newest_.header.stamp_ns, epoch_))
    log_drops_(spdlog::level::warn, "a health message is lost");
}

}  // namespace gvom::fusion
