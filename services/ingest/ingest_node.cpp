#include "services/ingest/ingest_node.hpp"

#include <spdlog/spdlog.h>

#include <cstdio>

#include "ipc/text.hpp"
#include "services/common/bus/pool_spec.hpp"
#include "services/common/config_concerns.hpp"
#include "services/common/config_file.hpp"
#include "services/ingest/loss_words.hpp"

namespace gvom::ingest {

using services::ExitCode;

namespace {

constexpr std::chrono::milliseconds kLongestWait{100};
constexpr std::int64_t kProgressPeriod_ns = 250'000'000;  // also while idle, so that a replay sees us
constexpr std::int64_t kLeastHealthPeriod_ns = 250'000'000;

}  // namespace

ipc::Expected<Bus> Bus::open(ipc::Runtime& runtime, const services::VehicleConfig& config,
                             const std::string& lidar) {
  auto odometry = ipc::Subscriber<ipc::Odometry>::open(runtime);
  if (!odometry) return tl::unexpected(odometry.error());
  auto progress = ipc::Subscriber<ipc::Progress>::open(runtime);
  if (!progress) return tl::unexpected(progress.error());
  auto maps =
      ipc::BrickMapPublisher::buffer_map(runtime, lidar, buffer_map_capacity(services::pool_spec(config)));
  if (!maps) return tl::unexpected(maps.error());
  auto own_progress = ipc::Publisher<ipc::Progress>::open(runtime);
  if (!own_progress) return tl::unexpected(own_progress.error());
  auto health = ipc::Publisher<ipc::Health>::open(runtime);
  if (!health) return tl::unexpected(health.error());
  auto waiter = ipc::Waiter::create(runtime);
  waiter.add(*odometry);
  waiter.add(*progress);
  return Bus{std::move(*odometry),     std::move(*progress), std::move(*maps),
             std::move(*own_progress), std::move(*health),   std::move(waiter)};
}

IngestNode::IngestNode(const services::VehicleConfig& config, const services::LidarConfig& lidar,
                       ipc::Runtime& runtime, Bus& bus, services::Lifecycle& lifecycle, Equipment equipment)
    : lidar_(lidar),
      bus_(bus),
      lifecycle_(lifecycle),
      device_(equipment.trust),
      broker_(runtime, lifecycle),
      health_(runtime.name(), services::config_hash(config, runtime.name())),
      counters_(health_),
      mapper_(config.mapper.map, std::move(equipment.backend.backend)),
      credit_(lidar.name),
      reader_(std::move(equipment.source), static_cast<std::size_t>(lidar.max_returns),
              queue_for(config.odometry.timeout_s, static_cast<std::size_t>(lidar.max_returns)),
              [this] { bus_.waiter.wake(); }),
      odometry_(config.odometry,
                reader_.is_live() ? OdometryIntake::Sweeps::live : OdometryIntake::Sweeps::recorded),
      ground_(lidar.geometry, config.mapper.vehicle),
      sensor_watch_(reader_.is_live() ? reader_.most_packets_per_s() : 0, lidar_, ipc::monotonic_ns()) {
  health_.set_backend(equipment.backend.name, equipment.backend.details);
  lifecycle_.on_stop([this] { bus_.waiter.wake(); });
}

IngestNode::~IngestNode() {
  lifecycle_.on_stop({});
}

ExitCode IngestNode::run() {
  services::notify_ready();
  ExitCode code = ExitCode::ok;
  while (!lifecycle_.stopping()) {
    take_odometry();
    const bool all_mapped = map_due_sweeps();
    if (failure_) {
      code = ExitCode::try_again;
      break;
    }
    if (all_mapped && is_settled()) acknowledged_sequence_ = odometry_sequence_;
    publish_progress();
    publish_health();
    while (const auto warning = reader_.new_warning()) spdlog::warn("{}", *warning);
    if (const auto error = reader_.error(); error && front_ == nullptr && reader_.at_end()) {
      spdlog::error("{}", *error);
      code = reader_.is_live() ? ExitCode::unavailable : ExitCode::bad_data;
      break;
    }
    bus_.waiter.wait(kLongestWait);
  }
  services::notify_stopping();
  health_.set_state(failure_ ? ipc::HealthState::failed : ipc::HealthState::stopping, failure_.value_or(""));
  send_health(ipc::monotonic_ns());
  spdlog::info("{} of {} sweeps mapped", counters_.mapped_sweeps, counters_.sweeps);
  if (const std::string dropped = counters_.dropped(); !dropped.empty())
    spdlog::info("not used: {}", dropped);
  for (const std::string& line : explain(losses_, odometry_)) spdlog::warn("{}", line);
  broker_.leave_if_gone();
  return code;
}

Sweep* IngestNode::front() {
  if (front_ != nullptr) return front_;
  front_ = reader_.take();
  if (front_ != nullptr)
    front_since_ns_ = front_->received_ns != 0 ? front_->received_ns : ipc::monotonic_ns();
  return front_;
}

void IngestNode::release_front() {
  if (front_ != nullptr) reader_.give_back(front_);
  front_ = nullptr;
}

bool IngestNode::map_due_sweeps() {
  while (const Sweep* const sweep = front()) {
    const Placement placement = odometry_.judge(*sweep, front_since_ns_, ipc::monotonic_ns());
    reader_.set_waiting(placement.when == Placement::When::later);
    if (placement.when == Placement::When::later) return true;
    if (placement.when == Placement::When::never) {
      drop(*sweep, placement.why);
    } else {
      if (lossless_ && !credit_.has_room(bus_.maps.sequence())) return false;
      map_sweep(*sweep);
    }
    release_front();
    if (lifecycle_.stopping() || failure_) return true;
  }
  return true;
}

void IngestNode::drop(const Sweep& sweep, SweepLoss why) {
  losses_.count(why, sweep.stamp_ns);
  odometry_.note(sweep, why, ipc::monotonic_ns());
  log_drops_(spdlog::level::warn, "a sweep is not mapped: {}", words_of(why));
}

void IngestNode::map_sweep(const Sweep& sweep) {
  const std::int64_t begin_ns = ipc::monotonic_ns();
  const auto shape = mapper_.count(sweep, odometry_.poses());
  if (!shape) return fail(shape.error());
  losses_.count_placed(sweep.stamp_ns);
  if (!publish(sweep, *shape, begin_ns)) return;
  ++counters_.mapped_sweeps;
  counters_.add(mapper_.filter_counts());
  ground_.see(sweep, mapper_.T_odom_base().translation_m);
  health_.count_product();
  last_map_ns_ = ipc::monotonic_ns();
  counters_.voxelize.record_ns(last_map_ns_ - begin_ns);
  services::notify_watchdog();
}

void IngestNode::fail(const SweepError& error) {
  ++counters_.backend_failures;
  failure_ = error.what;
  spdlog::critical("{}: leaving, to be started again", error.what);
  if (error.reason == SweepError::Reason::device) device_.note_failure({error.what});
}

bool IngestNode::publish(const Sweep& sweep, const BrickMapShape& shape, std::int64_t begin_ns) {
  auto writer = bus_.maps.loan(shape);
  if (!writer) {
    ++counters_.without_chunk;
    log_drops_(spdlog::level::err, "a map is lost: {}", writer.error().message);
    return false;
  }
  ipc::BrickMap& header = writer->header();
  header.grid = mapper_.grid();
  header.T_odom_base = record_of(mapper_.T_odom_base());
  const FilterCounts& filter = mapper_.filter_counts();
  header.ground = ground_.ground();
  header.columns_seen_fraction = static_cast<float>(sweep.columns_seen_fraction);
  header.flags = lossless_ ? ipc::BrickMap::kLossless : 0u;
  header.returns = filter.used;
  header.dropped_not_finite = filter.not_finite;
  header.dropped_too_near = filter.too_near;
  header.dropped_too_far = filter.too_far;
  header.dropped_body = filter.body;
  header.odometry_jump_ns = odometry_.poses().jump_before(sweep.stamp_ns);
  // A recording's sweep is there, as a sensor's would be, when the clock reaches it.
  header.mono_received_ns = sweep.received_ns != 0 ? sweep.received_ns : odometry_.came_ns();
  header.suspended_ns = sweep.received_ns != 0 ? sweep.suspended_ns : ipc::suspended_ns();
  header.mono_mapped_ns = begin_ns;
  counters_.wait.record_ns(begin_ns - header.mono_received_ns);
  if (const auto written = mapper_.write(writer->arrays()); !written) {
    fail({SweepError::Reason::device, written.error().what});
    return false;
  }
  bus_.maps.publish(std::move(*writer), sweep.stamp_ns, odometry_.epoch());
  return true;
}

// The reader may have handed a sweep over since the loop looked: one that is due is not settled.
bool IngestNode::is_settled() {
  if (reader_.is_live()) return true;
  if (front() == nullptr) return reader_.at_end();
  return odometry_.judge(*front_, front_since_ns_, ipc::monotonic_ns()).when == Placement::When::later;
}

std::int64_t IngestNode::odometry_stamp_ns() const {
  return odometry_.poses().empty() ? 0 : odometry_.poses().newest_ns();
}

// Only a replay that waits for its readers wants to know at once; each message costs all of them a wake-up.
void IngestNode::publish_progress() {
  const std::int64_t now_ns = ipc::monotonic_ns();
  ipc::Progress progress{};
  progress.odometry_sequence = acknowledged_sequence_;
  progress.maps_published = bus_.maps.sequence();
  const bool news = progress.odometry_sequence != told_odometry_ || progress.maps_published != told_maps_;
  const bool awaited = lossless_ || odometry_.has_ended();
  if (!(news && awaited) && now_ns < next_progress_ns_) return;
  ipc::set_text(progress.reader, lidar_.name);
  if (!bus_.own_progress.publish(progress, odometry_stamp_ns(), odometry_.epoch())) return;
  told_odometry_ = progress.odometry_sequence;
  told_maps_ = progress.maps_published;
  next_progress_ns_ = now_ns + kProgressPeriod_ns;
}

void IngestNode::publish_health() {
  const std::int64_t now_ns = ipc::monotonic_ns();
  const std::uint64_t faults = judge(now_ns);
  const bool news = faults != told_faults_ && now_ns - told_health_ns_ >= kLeastHealthPeriod_ns;
  if (!health_.due(now_ns) && !news) return;
  told_faults_ = faults;
  told_health_ns_ = now_ns;
  services::notify_watchdog();
  send_health(now_ns);
}

std::uint64_t IngestNode::judge(std::int64_t now_ns) {
  services::Words words;
  odometry_.describe(now_ns, words);
  if (reader_.is_live()) {
    const auto overruns = reader_.overruns();
    sensor_watch_.update(reader_.counters(), overruns.slow + overruns.waiting, now_ns);
    sensor_watch_.describe(words);
  } else if (const SourceCounters& c = reader_.counters(); c.sweeps == 0) {
    if (c.dropped_sweeps > 0) tell_dropped(100 * c.best_dropped_fraction, lidar_, words);
    if (c.misfit_sweeps > 0) tell_misfit(lidar_, words);
  }
  ground_.describe(words);
  const std::uint64_t faults = sensor_watch_.faults() | std::uint64_t{odometry_.faults(now_ns)} << 32;
  const bool through = !reader_.is_live() && odometry_.has_ended();
  const bool stale = !through && now_ns - last_map_ns_ >= 1'000'000'000;
  if (last_map_ns_ == 0) {
    if (words.empty()) describe_start(words);
    const bool lost = losses_.all() > 0;
    health_.set_state(lost ? ipc::HealthState::degraded : ipc::HealthState::starting, words.text());
  } else {
    if (stale && words.empty()) words.add(front_ != nullptr ? "no odometry" : "no sweeps");
    if (!device_.fallback().empty()) words.add("%s", device_.fallback().c_str());
    health_.set_state(words.empty() ? ipc::HealthState::ok : ipc::HealthState::degraded, words.text());
  }
  return faults;
}

void IngestNode::describe_start(services::Words& words) const {
  if (odometry_.poses().empty()) return words.add("no odometry yet");
  if (front_ != nullptr && !reader_.is_live())
    return words.add("no sweep mapped yet: the odometry has come to %.1f s, the next sweep is of %.1f s",
                     static_cast<double>(odometry_stamp_ns()) * 1e-9,
                     static_cast<double>(front_->stamp_ns) * 1e-9);
  const auto lost = explain(losses_, odometry_);
  words.add("%s", lost.empty() ? "no sweep yet" : lost.front().c_str());
}

void IngestNode::send_health(std::int64_t now_ns) {
  counters_.take(reader_.counters(), reader_.overruns());
  counters_.take(odometry_.counts(), losses_);
  counters_.lost_poses = bus_.odometry.counters().lost;
  counters_.report();
  health_.set_ground(ground_.ground());
  const ipc::Health& health = health_.take(now_ns);
  char status[128];
  std::snprintf(status, sizeof status, "%.1f maps/s, %s, %llu of %llu sweeps mapped", health.rate_hz,
                services::age_text(last_map_ns_, health.mono_ns).data(),
                static_cast<unsigned long long>(counters_.mapped_sweeps),
                static_cast<unsigned long long>(counters_.sweeps));
  services::notify_status(status);
  if (!bus_.health.publish(health, odometry_stamp_ns(), odometry_.epoch()))
    log_drops_(spdlog::level::warn, "a health message is lost");
}

}  // namespace gvom::ingest
