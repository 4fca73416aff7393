#include "services/bridge/bridge_node.hpp"

#include <algorithm>
#include <cmath>

#include <spdlog/spdlog.h>

#include "ipc/text.hpp"
#include "services/common/config_concerns.hpp"
#include "services/common/words.hpp"

namespace gvom::bridge {
namespace {

constexpr std::chrono::milliseconds kWait{20};           // odometry and Health are looked for so often
constexpr std::int64_t kTfPeriod_ns = 20'000'000;        // 50 Hz are enough for eyes
constexpr std::int64_t kLeaveVoxels_ns = 5'000'000'000;  // after the last that wanted them
constexpr std::int64_t kForget_ns = 60'000'000'000;  // a process that was stopped, and is silent for so long;
constexpr std::int64_t kForgetLost_ns = 60 * kForget_ns;  // one that fell silent
constexpr std::size_t kMostProcesses = 64;

ros::LayersView view_of(const ipc::LayersSample& sample) {
  const ipc::Layers& header = sample.header();
  ros::LayersView view{header.grid, header.T_odom_base, header.header.stamp_ns, {}};
  for (std::size_t i = 0; i < kLayers; ++i) {
    const auto id = static_cast<LayerId>(i);
    view.arrays[i] = layer_value_bytes(id) == 1 ? static_cast<const void*>(sample.layer_u8(id).data())
                                                : static_cast<const void*>(sample.layer_f(id).data());
  }
  return view;
}

bool is_forgotten(const ipc::Health& one, std::int64_t now_ns) {
  const bool stopped = one.state == static_cast<std::uint32_t>(ipc::HealthState::stopping);
  return now_ns - one.mono_ns > (stopped ? kForget_ns : kForgetLost_ns);
}

}  // namespace

BridgeNode::BridgeNode(const services::VehicleConfig& config, MessageSettings settings, Bus& bus,
                       const Sinks& sinks, services::Lifecycle& lifecycle)
    : config_(config),
      bus_(bus),
      sinks_(sinks),
      lifecycle_(lifecycle),
      broker_(bus.runtime, lifecycle),
      health_(bus.runtime.name(), services::config_hash(config, bus.runtime.name())),
      write_stage_(health_.stage("write")),
      layers_in_(health_.counter("layers_in")),
      layers_skipped_(health_.counter("layers_skipped")),
      layers_lost_(health_.counter("layers_lost")),
      voxels_in_(health_.counter("voxels_in")),
      plans_in_(health_.counter("plans_in")),
      odometry_in_(health_.counter("odometry_in")),
      bad_voxels_(health_.counter("drop_voxels_bad")),
      refused_(health_.counter("drop_refused")),
      maker_(std::move(settings)) {
  constexpr const char* kCounters[] = {"_sent", "_bytes", "_replaced", "_dropped", "_refused", "_clients"};
  for (const auto& sink : sinks_) {
    SinkReport report{*sink, {}, ""};
    for (std::size_t i = 0; i < report.counters.size(); ++i)
      report.counters[i] = &health_.counter(std::string(sink->name()) + kCounters[i]);
    reports_.push_back(std::move(report));
  }
  heard_.vehicle = config.name;
  lifecycle_.on_stop([this] { bus_.waiter.wake(); });
}

BridgeNode::~BridgeNode() {
  lifecycle_.on_stop({});
}

services::ExitCode BridgeNode::run() {
  services::notify_ready();
  while (!lifecycle_.stopping()) {
    bus_.waiter.wait(kWait);
    take_odometry();
    take_layers();
    take_voxels();
    take_plan();
    take_health();
    tell_each_second();
  }
  services::notify_stopping();
  health_.set_state(ipc::HealthState::stopping);
  publish_health(ipc::monotonic_ns());
  broker_.leave_if_gone();
  return services::ExitCode::ok;
}

bool BridgeNode::wanted(TopicId id) const {
  return std::any_of(sinks_.begin(), sinks_.end(), [&](const auto& sink) { return sink->wants(topic(id)); });
}

void BridgeNode::send(TopicId id, std::int64_t stamp_ns, const ros::Blob& message) {
  for (const auto& sink : sinks_)
    if (sink->wants(topic(id))) sink->offer(topic(id), stamp_ns, message);
}

void BridgeNode::take_odometry() {
  while (const auto sample = bus_.odometry.take()) {
    ++odometry_in_;
    heard_.odometry = **sample;
    heard_.odometry_mono_ns = ipc::monotonic_ns();
  }
  const std::int64_t now_ns = ipc::monotonic_ns();
  if (!heard_.odometry || heard_.odometry->header.stamp_ns == data_stamp_ns_ || now_ns < next_tf_ns_) return;
  next_tf_ns_ = now_ns + kTfPeriod_ns;
  data_stamp_ns_ = heard_.odometry->header.stamp_ns;
  data_came_ns_ = heard_.odometry_mono_ns;
  if (wanted(TopicId::tf))
    send(TopicId::tf, data_stamp_ns_, maker_.tf(data_stamp_ns_, heard_.odometry->T_odom_base));
}

void BridgeNode::take_layers() {
  const auto sample = bus_.layers.take_newest();
  if (!sample) return;
  ++layers_in_;
  heard_.layers = sample->header();
  if (!heard_.odometry) {
    data_stamp_ns_ = sample->header().header.stamp_ns;
    data_came_ns_ = ipc::monotonic_ns();
  }
  const auto period_ns = static_cast<std::int64_t>(1e9 / config_.bridge.rate_hz);
  const std::int64_t now_ns = ipc::monotonic_ns();
  // A quarter early is in time: layers at just this rate come a little early or late.
  if (now_ns < next_layers_ns_ - period_ns / 4) {
    ++layers_skipped_;
    return;
  }
  next_layers_ns_ = std::max(next_layers_ns_, now_ns - period_ns) + period_ns;
  send_layers(*sample);
  write_stage_.record_ns(ipc::monotonic_ns() - now_ns);
  health_.count_product();
}

void BridgeNode::send_layers(const ipc::LayersSample& sample) {
  const ros::LayersView view = view_of(sample);
  for (const TopicId id : MessageMaker::kOfLayers)
    if (wanted(id)) send(id, view.stamp_ns, maker_.of_layers(id, view));
}

void BridgeNode::join_or_leave_voxels() {
  const std::int64_t now_ns = ipc::monotonic_ns();
  if (wanted(TopicId::voxels)) {
    voxels_wanted_ns_ = now_ns;
    if (bus_.voxels) return;
    auto opened = ipc::BrickMapSubscriber::voxel_map(bus_.runtime);
    if (opened)
      bus_.voxels.emplace(std::move(*opened));
    else
      log_drops_(spdlog::level::warn, "no voxels: {}", opened.error().message);
  } else if (bus_.voxels && now_ns - voxels_wanted_ns_ > kLeaveVoxels_ns) {
    bus_.voxels.reset();
  }
}

void BridgeNode::take_voxels() {
  join_or_leave_voxels();
  if (!bus_.voxels) return;
  while (const auto sample = bus_.voxels->take()) {
    ++voxels_in_;
    if (!wanted(TopicId::voxels)) continue;
    if (const auto valid = sample->validate_deep(); !valid) {
      ++bad_voxels_;
      log_drops_(spdlog::level::warn, "a voxel map is not sent: {}", valid.error().why);
      continue;
    }
    const BrickMapView map = sample->view();
    send(TopicId::voxels, map.stamp_ns, maker_.voxels(map));
  }
}

void BridgeNode::take_plan() {
  while (const auto sample = bus_.plan.take()) {
    ++plans_in_;
    const ipc::Plan& plan = **sample;
    const std::int64_t stamp_ns = plan.header.stamp_ns;
    for (const TopicId id : {TopicId::plan, TopicId::trajectory})
      if (wanted(id)) send(id, stamp_ns, maker_.path(id, stamp_ns, plan));
  }
}

void BridgeNode::take_health() {
  while (const auto sample = bus_.health.take()) {
    const ipc::Health& health = **sample;
    const auto known = std::find_if(
        heard_.processes.begin(), heard_.processes.end(),
        [&](const ipc::Health& one) { return ipc::text_of(one.process) == ipc::text_of(health.process); });
    if (known != heard_.processes.end())
      *known = health;
    else if (heard_.processes.size() < kMostProcesses)
      heard_.processes.push_back(health);
  }
}

void BridgeNode::tell_each_second() {
  const std::int64_t now_ns = ipc::monotonic_ns();
  if (now_ns < next_second_ns_) return;
  next_second_ns_ = now_ns + 1'000'000'000;
  services::notify_watchdog();
  tell_sinks();
  publish_health(now_ns);
  auto& processes = heard_.processes;
  const auto is_over = [&](const auto& one) { return is_forgotten(one, now_ns); };
  processes.erase(std::remove_if(processes.begin(), processes.end(), is_over), processes.end());
  // Also while no data comes: an outage has its length.
  const std::int64_t stamp_ns = data_stamp_ns_ == 0 ? 0 : data_stamp_ns_ + now_ns - data_came_ns_;
  if (wanted(TopicId::diagnostics))
    send(TopicId::diagnostics, stamp_ns, maker_.diagnostics(stamp_ns, processes, now_ns));
  if (wanted(TopicId::status))
    send(TopicId::status, stamp_ns, maker_.status(status_json(heard_, ipc::Moment::now())));
}

/// Their counters and problems, to Health and to the log.
void BridgeNode::tell_sinks() {
  services::Words words;
  for (SinkReport& report : reports_) {
    const SinkCounters c = report.sink.counters();
    const std::uint64_t values[] = {c.sent, c.bytes, c.replaced, c.dropped, c.refused, c.clients};
    for (std::size_t i = 0; i < report.counters.size(); ++i) *report.counters[i] = values[i];
    const std::string problem = report.sink.problem();
    const std::string name(report.sink.name());
    if (!problem.empty()) words.add("%s: %s", name.c_str(), problem.c_str());
    if (problem != report.told_problem)
      problem.empty() ? spdlog::info("{}: well again", name) : spdlog::warn("{}: {}", name, problem);
    report.told_problem = problem;
  }
  health_.set_state(words.empty() ? ipc::HealthState::ok : ipc::HealthState::degraded, words.text());
}

void BridgeNode::publish_health(std::int64_t now_ns) {
  layers_lost_ = bus_.layers.counters().lost;
  refused_ = bus_.layers.counters().refused() + bus_.odometry.counters().refused() +
             bus_.plan.counters().refused() + bus_.health.counters().refused() +
             (bus_.voxels ? bus_.voxels->counters().refused() : 0);
  if (const auto why = bus_.layers.new_refusal()) spdlog::warn("{}", *why);
  if (!bus_.own_health.publish(health_.take(now_ns), 0, 0))
    log_drops_(spdlog::level::warn, "a health message is lost");
}

}  // namespace gvom::bridge
