#include "services/planner/process/planner_node.hpp"

#include <spdlog/spdlog.h>

#include <cstdio>
#include <utility>

#include "ipc/clock.hpp"
#include "ipc/freshness.hpp"
#include "services/common/config_concerns.hpp"
#include "services/planner/process/plan_message.hpp"

namespace gvom::planner {
namespace {

constexpr std::int64_t kOdometrySilence_ns = 300'000'000;  // older poses say nothing of where it is now
constexpr double kDeadlineCycles = 2.5;  // a command holds for so many: one that is late is made up for
constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kAhead_ns = kSecond_ns / 2;  // layers are no newer than the odometry that placed them

std::int64_t period_ns(const PlannerConfig& config) {
  return static_cast<std::int64_t>(kSecond_ns / config.rate_hz);
}

double seconds(std::int64_t time_ns) {
  return 1e-9 * static_cast<double>(time_ns);
}

MapView view_of(const ipc::LayersSample& layers) {
  return {layers.header().header.stamp_ns,           layers.header().grid,
          layers.layer_f(LayerId::height).data(),    layers.layer_f(LayerId::slope).data(),
          layers.layer_f(LayerId::roughness).data(), layers.layer_f(LayerId::clearance).data(),
          layers.layer_u8(LayerId::flags).data(),    layers.layer_u8(LayerId::visibility).data()};
}

/// Nothing is wrong with a stand for that.
bool stands_as_wanted(Reason reason) {
  return reason == Reason::no_course || reason == Reason::near_goal || reason == Reason::mover;
}

}  // namespace

ipc::Expected<Bus> Bus::open(ipc::Runtime& runtime) {
  auto waiter = ipc::Waiter::create(runtime);
  auto layers = ipc::LayersSubscriber::open(runtime);
  if (!layers) return tl::unexpected(layers.error());
  auto odometry = ipc::Subscriber<ipc::Odometry>::open(runtime);
  if (!odometry) return tl::unexpected(odometry.error());
  auto course = ipc::Subscriber<ipc::Course>::open(runtime);
  if (!course) return tl::unexpected(course.error());
  auto plan = ipc::Publisher<ipc::Plan>::open(runtime);
  if (!plan) return tl::unexpected(plan.error());
  auto command = ipc::Publisher<ipc::Command>::open(runtime);
  if (!command) return tl::unexpected(command.error());
  auto health = ipc::Publisher<ipc::Health>::open(runtime);
  if (!health) return tl::unexpected(health.error());
  return Bus{std::move(waiter), std::move(*layers),  std::move(*odometry), std::move(*course),
             std::move(*plan),  std::move(*command), std::move(*health)};
}

PlannerNode::PlannerNode(const services::VehicleConfig& config, ipc::Runtime& runtime, Bus& bus,
                         services::Lifecycle& lifecycle, const std::vector<Eigen::Vector2d>& course)
    : config_(config),
      bus_(bus),
      lifecycle_(lifecycle),
      broker_(runtime, lifecycle),
      health_(runtime.name(), services::config_hash(config, runtime.name())),
      cycle_stage_(health_.stage("cycle")),
      planner_(config.planner, config.mapper.map.size_xy),
      motion_(config.odometry),
      sides_(sides_of(config.lidars)),
      record_(CourseRecord::path_of(runtime.name())),
      message_(std::make_unique<ipc::Plan>()) {
  const std::pair<const char*, const std::uint64_t*> rows[] = {{"cycles", &counts_.cycles},
                                                               {"overruns", &counts_.overruns},
                                                               {"stops", &counts_.stops},
                                                               {"layers_in", &counts_.layers_in},
                                                               {"odometry_in", &counts_.odometry_in},
                                                               {"courses_in", &counts_.courses_in},
                                                               {"drop_odometry", &counts_.bad_odometry},
                                                               {"odometry_jumps", &counts_.odometry_jumps},
                                                               {"drop_no_chunk", &counts_.without_chunk}};
  for (const auto& [name, value] : rows) counters_.emplace_back(&health_.counter(name), value);
  if (!course.empty()) follow(course, name_of(0, 0, course));
  bus_.waiter.add(bus_.course);
  bus_.waiter.add(bus_.odometry);  // when a pose came says how far the vehicle is beyond it
  lifecycle_.on_stop([this] { bus_.waiter.wake(); });
}

PlannerNode::~PlannerNode() {
  lifecycle_.on_stop({});
}

services::ExitCode PlannerNode::run() {
  services::notify_ready();
  std::int64_t next_ns = ipc::monotonic_ns();
  while (!lifecycle_.stopping()) {
    const std::int64_t now_ns = ipc::monotonic_ns();
    take_course();
    take_odometry();
    if (now_ns < next_ns) {
      bus_.waiter.wait(std::chrono::milliseconds((next_ns - now_ns) / 1'000'000 + 1));
      continue;
    }
    next_ns = std::max(next_ns + period_ns(config_.planner), now_ns);
    cycle(now_ns);
    publish_health();
  }
  services::notify_stopping();
  health_.set_state(ipc::HealthState::stopping);
  command(planner_.stand(Reason::no_course, "the planner stops"));
  if (course_name_.is_of_file()) record_.forget();  // who starts it by hand again means all of the file
  spdlog::info("{} cycles, {} of them overran", counts_.cycles, counts_.overruns);
  broker_.leave_if_gone();
  return services::ExitCode::ok;
}

void PlannerNode::take_odometry() {
  while (const auto sample = bus_.odometry.take()) {
    const ipc::Odometry& message = **sample;
    const StampedPose pose{message.header.stamp_ns, pose_of(message.T_odom_base)};
    switch (motion_.take(pose, message.header.epoch)) {
      case MotionNews::jump:
      case MotionNews::anew:
        ++counts_.odometry_jumps;
        jumped_ = true;
        jump_stamp_ns_ = message.header.stamp_ns;
        [[fallthrough]];
      case MotionNews::used:
        ++counts_.odometry_in;
        odometry_ns_ = ipc::monotonic_ns();
        break;
      case MotionNews::old_epoch:
      case MotionNews::backwards:
      case MotionNews::not_a_pose:
        ++counts_.bad_odometry;
        break;
    }
  }
}

void PlannerNode::take_course() {
  while (const auto sample = bus_.course.take()) {
    const ipc::Course& course = **sample;
    ++counts_.courses_in;
    std::vector<Eigen::Vector2d> places;
    for (std::uint32_t i = 0; i < course.count; ++i)
      places.emplace_back(course.places[i].x_m, course.places[i].y_m);
    const CourseName name = name_of(sample->publisher(), course.header.sequence, places);
    follow(std::move(places), name);
  }
}

void PlannerNode::follow(std::vector<Eigen::Vector2d> course, const CourseName& name) {
  const std::size_t first = record_.place_of(name);
  spdlog::info("a course of {} places{}", course.size(),
               first == 0 ? "" : fmt::format(", {} of them reached before this start", first));
  course_ = course;
  course_name_ = name;
  planner_.set_course(std::move(course), first);
}

void PlannerNode::take_layers() {
  auto newest = bus_.layers.take_newest();
  if (!newest) return;
  ++counts_.layers_in;
  layers_ = std::move(*newest);
}

void PlannerNode::cycle(std::int64_t begun_ns) {
  take_layers();
  const Plan& plan = decide(begun_ns);
  publish(plan, begun_ns);
  if (!course_.empty()) record_.note(course_name_, plan.waypoint);
  took_ns_ = ipc::monotonic_ns() - begun_ns;
  cycle_stage_.record_ns(took_ns_);
  ++counts_.cycles;
  if (plan.mode == Mode::stop) ++counts_.stops;
  health_.count_product();
  const bool well = stands_as_wanted(plan.reason) || (plan.mode != Mode::stop && plan.mode != Mode::gave_up);
  health_.set_state(well ? ipc::HealthState::ok : ipc::HealthState::degraded, well ? "" : plan.why);
  tell(plan);
}

const Plan& PlannerNode::decide(std::int64_t now_ns) {
  const std::int64_t silent_ns = std::max<std::int64_t>(now_ns - odometry_ns_, 0);
  const auto state = motion_.state_after(silent_ns);
  if (!state) return planner_.stand(Reason::no_odometry, "no odometry yet");
  if (silent_ns > kOdometrySilence_ns) {
    char why[64];
    std::snprintf(why, sizeof why, "no odometry for %.1f s", seconds(silent_ns));
    return planner_.stand(Reason::no_odometry, why);
  }
  Senses senses = look();
  if (took_ns_ > period_ns(config_.planner)) {
    ++counts_.overruns;
    senses.overrun_s = seconds(took_ns_);
  }
  const bool usable = layers_ && layers_fit(*state);
  const MapView view = usable ? view_of(*layers_) : MapView{};
  const Plan& plan = planner_.cycle(usable ? &view : nullptr, *state, senses);
  jumped_ = false;
  return plan;
}

bool PlannerNode::layers_fit(const State& state) const {
  const ipc::MessageHeader& header = layers_->header().header;
  return header.epoch == motion_.epoch() && header.stamp_ns >= jump_stamp_ns_ &&
         header.stamp_ns <= state.stamp_ns + kAhead_ns;
}

Senses PlannerNode::look() const {
  Senses senses;
  senses.odometry_jumped = jumped_;
  if (!layers_) return senses;
  senses.layers_age_s = std::chrono::duration<double>(layers_->age()).count();
  senses.blind_ahead = is_blind(layers_->header(), sides_.ahead);
  senses.blind_behind = is_blind(layers_->header(), sides_.behind);
  return senses;
}

void PlannerNode::publish(const Plan& plan, std::int64_t begun_ns) {
  command(plan);
  fill(plan, *message_);
  message_->waypoints = static_cast<std::uint32_t>(course_.size());
  const bool has_goal = plan.waypoint < course_.size();
  message_->goal_x_m = has_goal ? course_[plan.waypoint].x() : 0;
  message_->goal_y_m = has_goal ? course_[plan.waypoint].y() : 0;
  message_->layers_age_s = layers_ ? std::chrono::duration<double>(layers_->age()).count() : HUGE_VAL;
  message_->mono_begun_ns = begun_ns;
  message_->mono_published_ns = ipc::monotonic_ns();
  const auto state = motion_.state();
  if (!bus_.plan.publish(*message_, state ? state->stamp_ns : 0, motion_.epoch())) ++counts_.without_chunk;
}

void PlannerNode::command(const Plan& plan) {
  ipc::Command command{};
  command.speed_mps = plan.command.speed_mps;
  command.curvature_per_m = plan.command.curvature_per_m;
  command.mode = static_cast<std::uint32_t>(plan.mode);
  const auto holds_ns =
      static_cast<std::int64_t>(kDeadlineCycles * static_cast<double>(period_ns(config_.planner)));
  command.mono_deadline_ns = ipc::monotonic_ns() + holds_ns;
  const auto state = motion_.state();
  if (!bus_.command.publish(command, state ? state->stamp_ns : 0, motion_.epoch())) {
    ++counts_.without_chunk;
    log_drops_(spdlog::level::warn, "a command is lost: no chunk");
  }
}

void PlannerNode::tell(const Plan& plan) {
  const auto reason = static_cast<std::uint32_t>(plan.reason) << 8 | static_cast<std::uint32_t>(plan.mode);
  if (reason == told_reason_) return;
  told_reason_ = reason;
  spdlog::info("{}", plan.why);
}

void PlannerNode::publish_health() {
  const std::int64_t now_ns = ipc::monotonic_ns();
  if (!health_.due(now_ns)) return;
  services::notify_watchdog();
  for (const auto& [counter, value] : counters_) *counter = *value;
  const ipc::Health& health = health_.take(now_ns);
  services::notify_status(message_->why);
  if (!bus_.health.publish(health, 0, motion_.epoch()))
    log_drops_(spdlog::level::warn, "a health message is lost");
}

}  // namespace gvom::planner
