#include "services/ingest/ingest_node.hpp"

#include <spdlog/spdlog.h>

#include <cstdio>

#include "ipc/text.hpp"
#include "services/common/bus/core_types.hpp"
#include "services/common/bus/pool_spec.hpp"
#include "services/common/config_file.hpp"

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
      odometry_timeout_ns_(static_cast<std::int64_t>(config.odometry.timeout_s * 1e9)),
      bus_(bus),
      lifecycle_(lifecycle),
      broker_(runtime),
      health_(runtime.name(), services::config_hash(config)),
      counters_(health_),
      mapper_(config.mapper.map, std::move(equipment.backend.backend)),
      credit_(lidar.name),
      reader_(std::move(equipment.source), static_cast<std::size_t>(lidar.max_returns),
              [this] { bus_.waiter.wake(); }),
      sensor_watch_(reader_.is_live() ? reader_.most_packets_per_s() : 0, ipc::monotonic_ns()),
      odometry_watch_(config.odometry) {
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
    broker_.check();
    while (const auto warning = reader_.new_warning()) spdlog::warn("{}", *warning);
    if (const auto error = reader_.error(); error && reader_.at_end()) {
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
  broker_.leave_if_gone();
  return code;
}

bool IngestNode::map_due_sweeps() {
  while (const auto stamp_ns = reader_.front_stamp()) {
    if (!is_due(*stamp_ns)) {
      if (!give_up_late_sweep(*stamp_ns)) return true;
      continue;
    }
    if (lossless_ && !credit_.has_room(bus_.maps.sequence())) return false;
    Sweep* const sweep = reader_.take();
    if (sweep == nullptr) continue;
    map_sweep(*sweep);
    reader_.give_back(sweep);
    front_since_ns_ = 0;
    if (lifecycle_.stopping() || failure_) return true;
  }
  return true;
}

// A sensor's sweep waits for odometry only so long (R3). A recording's waits for the replay's clock, until
// that says that it is through.
bool IngestNode::give_up_late_sweep(std::int64_t stamp_ns) {
  const std::int64_t now_ns = ipc::monotonic_ns();
  if (front_since_ns_ == 0 || front_stamp_ns_ != stamp_ns) {
    front_since_ns_ = now_ns;
    front_stamp_ns_ = stamp_ns;
  }
  const bool late = reader_.is_live() && now_ns - front_since_ns_ > odometry_timeout_ns_;
  const bool left_over = !reader_.is_live() && end_of_stream_;
  if (!late && !left_over) return false;
  Sweep* const sweep = reader_.take();
  if (sweep == nullptr) return true;
  reader_.give_back(sweep);
  ++(late ? counters_.odometry_timeouts : counters_.after_odometry);
  if (late)
    log_drops_(spdlog::level::warn, "no odometry for a sweep within {} s: dropped",
               static_cast<double>(odometry_timeout_ns_) * 1e-9);
  return true;
}

void IngestNode::map_sweep(const Sweep& sweep) {
  const std::int64_t begin_ns = ipc::monotonic_ns();
  const auto shape = mapper_.count(sweep, odometry_);
  if (!shape && shape.error().reason == SweepError::Reason::device) return fail(shape.error().what);
  if (!shape) {
    ++(odometry_broken_ ? counters_.in_odometry_gap : counters_.before_odometry);
    log_drops_(spdlog::level::info, "a sweep began before the odometry{}: dropped",
               odometry_broken_ ? " went on" : "");
    return;
  }
  if (!publish(sweep, *shape, begin_ns)) return;
  ++counters_.mapped_sweeps;
  counters_.add(mapper_.filter_counts());
  health_.count_product();
  last_map_ns_ = ipc::monotonic_ns();
  counters_.voxelize.record_ns(last_map_ns_ - begin_ns);
  services::notify_watchdog();
}

void IngestNode::fail(const std::string& what) {
  ++counters_.backend_failures;
  failure_ = what;
  spdlog::critical("{}: leaving, to be started again", what);
}

bool IngestNode::publish(const Sweep& sweep, const BrickMapShape& shape, std::int64_t begin_ns) {
  auto writer = bus_.maps.loan(shape.brick_slots, shape.brick_count, shape.record_count);
  if (!writer) {
    ++counters_.without_chunk;
    log_drops_(spdlog::level::err, "a map is lost: {}", writer.error().message);
    return false;
  }
  ipc::BrickMap& header = writer->header();
  services::set_frame(mapper_.grid(), mapper_.T_odom_base(), header);
  const FilterCounts& filter = mapper_.filter_counts();
  header.columns_seen_fraction = static_cast<float>(sweep.columns_seen_fraction);
  header.flags = lossless_ ? ipc::BrickMap::kLossless : 0u;
  header.returns = filter.used;
  header.dropped_not_finite = filter.not_finite;
  header.dropped_too_near = filter.too_near;
  header.dropped_too_far = filter.too_far;
  header.dropped_body = filter.body;
  header.odometry_jump_ns = odometry_jump_ns_;
  // A recording's sweep is there, as a sensor's would be, when the clock reaches it.
  header.mono_received_ns = sweep.received_ns != 0 ? sweep.received_ns : odometry_came_ns_;
  header.suspended_ns = ipc::suspended_ns();
  header.mono_mapped_ns = begin_ns;
  counters_.wait.record_ns(begin_ns - header.mono_received_ns);
  if (const auto written = mapper_.write(services::arrays_of(*writer)); !written) {
    fail(written.error().what);
    return false;
  }
  bus_.maps.publish(std::move(*writer), sweep.stamp_ns, epoch_);
  return true;
}

bool IngestNode::is_due(std::int64_t stamp_ns) const {
  return !odometry_.empty() && odometry_.newest_ns() >= stamp_ns;
}

// The reader may have handed a sweep over since the loop looked: one that is due is not settled.
bool IngestNode::is_settled() const {
  if (reader_.is_live()) return true;
  const auto stamp_ns = reader_.front_stamp();
  return stamp_ns ? !is_due(*stamp_ns) : reader_.at_end();
}

// Only a replay that waits for its readers wants to know at once; each message costs all of them a wake-up.
void IngestNode::publish_progress() {
  const std::int64_t now_ns = ipc::monotonic_ns();
  ipc::Progress progress{};
  progress.odometry_sequence = acknowledged_sequence_;
  progress.maps_published = bus_.maps.sequence();
  const bool news = progress.odometry_sequence != told_odometry_ || progress.maps_published != told_maps_;
  const bool awaited = lossless_ || end_of_stream_;
  if (!(news && awaited) && now_ns < next_progress_ns_) return;
  ipc::set_text(progress.reader, lidar_.name);
  const std::int64_t stamp_ns = odometry_.empty() ? 0 : odometry_.newest_ns();
  if (!bus_.own_progress.publish(progress, stamp_ns, epoch_)) return;
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
  std::uint64_t faults = 0;
  if (reader_.is_live() && !end_of_stream_) {
    sensor_watch_.update(reader_.counters(), reader_.overruns(), now_ns);
    odometry_watch_.describe(now_ns, words);
    sensor_watch_.describe(words);
    faults = sensor_watch_.faults() | std::uint64_t{odometry_watch_.faults(now_ns)} << 32;
  }
  const bool stale = !end_of_stream_ && now_ns - last_map_ns_ >= 1'000'000'000;
  if (last_map_ns_ == 0) {
    if (words.empty()) words.add(odometry_.empty() ? "no odometry yet" : "no sweep yet");
    health_.set_state(ipc::HealthState::starting, words.text());
  } else if (stale || !words.empty()) {
    if (words.empty()) words.add(reader_.front_stamp() ? "no odometry" : "no sweeps");
    health_.set_state(ipc::HealthState::degraded, words.text());
  } else {
    health_.set_state(ipc::HealthState::ok);
  }
  return faults;
}

void IngestNode::send_health(std::int64_t now_ns) {
  counters_.take(reader_.counters());
  counters_.overruns = reader_.overruns();
  counters_.lost_poses = bus_.odometry.counters().lost;
  counters_.report();
  const ipc::Health& health = health_.take(now_ns);
  char status[128];
  std::snprintf(status, sizeof status, "%.1f maps/s, %s, %llu of %llu sweeps mapped", health.rate_hz,
                services::age_text(last_map_ns_, health.mono_ns).data(),
                static_cast<unsigned long long>(counters_.mapped_sweeps),
                static_cast<unsigned long long>(counters_.sweeps));
  services::notify_status(status);
  if (!bus_.health.publish(health, odometry_.empty() ? 0 : odometry_.newest_ns(), epoch_))
    log_drops_(spdlog::level::warn, "a health message is lost");
}

}  // namespace gvom::ingest
