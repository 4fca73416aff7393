#include "services/fusion/fusion_node.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>
#include <utility>

#include "services/common/bus/pool_spec.hpp"
#include "services/common/config_concerns.hpp"

namespace gvom::fusion {

namespace {

constexpr std::chrono::milliseconds kLongestWait{100};

ipc::Topic newest_odometry() {
  ipc::Topic topic = ipc::topic_of<ipc::Odometry>();
  topic.queue = 1;
  return topic;
}

}  // namespace

ipc::Expected<Bus> Bus::open(ipc::Runtime& runtime, const services::VehicleConfig& config) {
  auto waiter = ipc::Waiter::create(runtime);
  auto inbox = MapInbox::open(runtime, waiter, config);
  if (!inbox) return tl::unexpected(inbox.error());
  auto odometry = ipc::InPort::open(runtime, newest_odometry());
  if (!odometry) return tl::unexpected(odometry.error());
  auto others = ipc::Subscriber<ipc::Progress>::open(runtime);
  if (!others) return tl::unexpected(others.error());
  auto layers = ipc::LayersPublisher::open(runtime);
  if (!layers) return tl::unexpected(layers.error());
  auto voxels = ipc::BrickMapPublisher::voxel_map(runtime, voxel_map_capacity(services::pool_spec(config)));
  if (!voxels) return tl::unexpected(voxels.error());
  auto progress = ipc::Publisher<ipc::Progress>::open(runtime);
  if (!progress) return tl::unexpected(progress.error());
  auto health = ipc::Publisher<ipc::Health>::open(runtime);
  if (!health) return tl::unexpected(health.error());
  return Bus{std::move(waiter),  std::move(*inbox),  std::move(*odometry), std::move(*others),
             std::move(*layers), std::move(*voxels), std::move(*progress), std::move(*health)};
}

FusionNode::FusionNode(const services::VehicleConfig& config, ipc::Runtime& runtime, Bus& bus,
                       services::Lifecycle& lifecycle, const services::DeviceTrust& trust,
                       OpenBackend<FusionBackend> backend)
    : config_(config),
      bus_(bus),
      lifecycle_(lifecycle),
      device_(trust),
      broker_(runtime, lifecycle),
      health_(runtime.name(), services::config_hash(config, runtime.name())),
      counters_(health_),
      fuser_(std::move(backend.backend)),
      unknown_(config.lidars) {
  health_.set_backend(backend.name, backend.details);
  lifecycle_.on_stop([this] { bus_.waiter.wake(); });
}

FusionNode::~FusionNode() {
  lifecycle_.on_stop({});
}

services::ExitCode FusionNode::run() {
  services::notify_ready();
  while (!lifecycle_.stopping()) {
    hear_others();
    fuse_arrived();
    if (layers_due()) publish_layers();
    publish_voxels();
    if (failure_) break;
    publish_progress();
    publish_health();
    auto timeout = kLongestWait;
    if (config_.fusion.rate_hz > 0 && fresh_)
      timeout = std::clamp(std::chrono::milliseconds((next_tick_ns_ - ipc::monotonic_ns()) / 1'000'000 + 1),
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
  // No more than fits the queues: maps that come faster than they are fused must not keep it from its layers.
  const std::size_t most = bus_.inbox.lidars().size() * ipc::kBufferMapQueue;
  for (std::size_t i = 0; i < most; ++i) {
    const auto map = bus_.inbox.take();
    if (!map) break;
    const bool lossless = (map->sample->header().flags & ipc::BrickMap::kLossless) != 0;
    hear_others();
    fuse(*map);
    if (failure_) return;
    if (lossless && layers_due()) publish_layers();
    if (lossless) publish_progress();
    publish_health();
    if (lifecycle_.stopping() || failure_) return;
  }
  if (const auto refusal = bus_.inbox.new_refusal()) complain(*refusal);
}

void FusionNode::hear_others() {
  while (const auto odometry = bus_.odometry.take())
    trust_.take(*reinterpret_cast<const ipc::MessageHeader*>(odometry->data()));
  while (const auto progress = bus_.others.take()) unknown_.take(**progress, ipc::monotonic_ns());
  for (const auto& refusal : {bus_.odometry.new_refusal(), bus_.others.new_refusal()})
    if (refusal) complain(*refusal);
  if (!trust_.was_deceived()) return;
  complain("maps of times that the odometry now contradicts were fused: the window is emptied");
  trust_.forget();
  epoch_ = 0;
  jump_ns_ = 0;
  empty_window();
}

void FusionNode::fuse(const ArrivedMap& map) {
  const ipc::BrickMap& header = map.sample->header();
  ++counters_.maps_in;
  progress_news_ = true;
  if (const auto sound = map.sample->validate_deep(); !sound)
    return refuse(map, sound.error().part, sound.error().why);
  const std::int64_t now_ns = ipc::monotonic_ns();
  if (const auto lie = trust_.judge(header, now_ns)) return refuse(map, lie->about, lie->why);
  lateness_.took(header, now_ns);
  if (!place_in_time(header)) return bus_.inbox.release(map.token);
  const std::int64_t fuse_ns = ipc::monotonic_ns();
  const auto result = fuser_.add({map.sample->view(), map.lidar, map.token});
  if (!result) {  // the device may still read the map: it is not released
    ++counters_.backend_failures;
    return fail(result.error());
  }
  if (*result != AddResult::added) return refuse(map, *result);
  fused_ns_ = ipc::monotonic_ns();
  counters_.fuse.record_ns(fused_ns_ - fuse_ns);
  ++counters_.maps_fused;
  if (fresh_) ++counters_.maps_sharing_layers;
  fresh_ = true;
  trust_.believe(header);
  bus_.inbox.note_fused(map);
  newest_stamp_ns_ = fuser_.window().maps().front().view.stamp_ns;
  for (const WindowMap& left : fuser_.window().left()) bus_.inbox.release(left.token);
}

/// False if the map is of before the window's epoch or the odometry's last jump; of after, it begins anew.
bool FusionNode::place_in_time(const ipc::BrickMap& header) {
  if (header.header.epoch > epoch_) begin_epoch(header.header.epoch);
  if (header.header.epoch < epoch_) {
    ++counters_.maps_of_old_epoch;
    return false;
  }
  if (header.odometry_jump_ns > jump_ns_) begin_after_jump(header.odometry_jump_ns);
  if (jump_ns_ == 0 || header.header.stamp_ns >= jump_ns_) return true;
  ++counters_.maps_before_jump;
  return false;
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
  complain("the odometry has jumped: the window is emptied");
  jump_ns_ = stamp_ns;
  empty_window();
}

void FusionNode::empty_window() {
  fuser_.reset();
  if (fresh_) ++counters_.maps_sharing_layers;
  fresh_ = false;
  voxels_fresh_ = false;
  for (const WindowMap& left : fuser_.window().left()) bus_.inbox.release(left.token);
  bus_.inbox.forget_fused();
}

/// Before its epoch or jump is looked at.
template <typename Part>
void FusionNode::refuse(const ArrivedMap& map, Part part, const std::string& why) {
  counters_.count_drop(part);
  complain("lidar " + bus_.inbox.lidars()[static_cast<std::size_t>(map.lidar)].name + ": " + why);
  bus_.inbox.release(map.token);
}

void FusionNode::complain(std::string why) {
  complaint_ = std::move(why);
  complaint_ns_ = ipc::monotonic_ns();
  log_drops_(spdlog::level::err, "{}", complaint_);
}

void FusionNode::refuse(const ArrivedMap& map, AddResult result) {
  counters_.count_drop(result);
  if (result == AddResult::wrong_grid)
    complain("lidar " + bus_.inbox.lidars()[static_cast<std::size_t>(map.lidar)].name +
             ": its map has another grid: do all processes have the same configuration?");
  bus_.inbox.release(map.token);
}

void FusionNode::fail(const DeviceError& error) {
  failure_ = error.what;
  fresh_ = false;
  voxels_fresh_ = false;
  spdlog::critical("{}: leaving, to be started again", error.what);
  device_.note_failure(error);
}

}  // namespace gvom::fusion
