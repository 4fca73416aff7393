#include "tools/drive/live/live_session.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <utility>

#include "core/column_grid.hpp"
#include "ipc/clock.hpp"
#include "services/ingest/udp_ports.hpp"
#include "tools/drive/live/messages.hpp"

namespace gvom::driving {
namespace {

constexpr int kStepsPerTurn = 10;
constexpr double kStands_mps = 0.05;

/// Those of the rig with their names and the ports that their sources listen at.
tl::expected<std::vector<sim::LidarModel>, std::string> lidars_of(const services::VehicleConfig& config,
                                                                  const SessionOptions& options) {
  std::vector<sim::LidarModel> lidars = make_lidars(rig_of(config, options.sensor), options.seed);
  for (std::size_t i = 0; i < lidars.size(); ++i) {
    const services::LidarConfig& lidar = config.lidars[i];
    const auto port = ingest::live_port(lidar.source);
    if (!port) return tl::unexpected("lidar " + lidar.name + ": its source is no ouster-udp:PORT");
    lidars[i].name = lidar.name;
    lidars[i].udp_port = *port;
  }
  return lidars;
}

}  // namespace

ipc::Expected<LiveBus> LiveBus::open(ipc::Runtime& runtime) {
  auto vehicle = VehicleBus::open(runtime);
  if (!vehicle) return tl::unexpected(vehicle.error());
  auto course = ipc::Publisher<ipc::Course>::open(runtime);
  if (!course) return tl::unexpected(course.error());
  auto plan = ipc::Subscriber<ipc::Plan>::open(runtime);
  if (!plan) return tl::unexpected(plan.error());
  auto layers = ipc::LayersSubscriber::open(runtime);
  if (!layers) return tl::unexpected(layers.error());
  return LiveBus{std::move(*vehicle), std::move(*course), std::move(*plan), std::move(*layers)};
}

tl::expected<void, std::string> write_metadata(const services::VehicleConfig& config,
                                               const SessionOptions& options, const std::string& folder) {
  const auto lidars = lidars_of(config, options);
  if (!lidars) return tl::unexpected(lidars.error());
  for (const sim::LidarModel& lidar : *lidars) {
    const std::string path = folder + "/" + lidar.name + ".json";
    std::ofstream file(path);
    file << sim::ouster_metadata(lidar);
    file.close();
    if (!file) return tl::unexpected(path + ": cannot be written");
  }
  return {};
}

LiveSession::LiveSession(const CourseWorld& course, const sim::World& world, const TrueObstacles& obstacles,
                         const services::VehicleConfig& config, const SessionOptions& options, LiveBus bus)
    : course_(course),
      obstacles_(obstacles),
      bus_(std::move(bus)),
      begin_(std::chrono::steady_clock::now()),
      vehicle_(std::make_unique<LiveVehicle>(world, rig_of(config, options.sensor).model, course.start,
                                             options.odometry_noise, options.seed, std::move(bus_.vehicle))),
      talk_(course.waypoints_m, vehicle_->epoch(), config.planner.max_age_s),
      shown_(config.mapper.map) {}

tl::expected<std::unique_ptr<LiveSession>, std::string> LiveSession::start(
    const CourseWorld& course, const sim::World& world, const TrueObstacles& obstacles,
    const services::VehicleConfig& config, const SessionOptions& options, LiveBus bus) {
  auto lidars = lidars_of(config, options);
  if (!lidars) return tl::unexpected(lidars.error());
  std::unique_ptr<LiveSession> session(
      new LiveSession(course, world, obstacles, config, options, std::move(bus)));
  session->lidars_ = std::move(*lidars);
  for (const sim::LidarModel& lidar : session->lidars_) {
    auto sender = play::UdpSender::open("127.0.0.1");
    if (!sender) return tl::unexpected(sender.error());
    LiveVehicle& vehicle = *session->vehicle_;
    session->streams_.push_back(std::make_unique<LidarStream>(
        world, vehicle, [&vehicle] { return vehicle.time_s(); }, lidar, options.seed, std::move(*sender),
        session->begin_));
  }
  return session;
}

std::chrono::steady_clock::time_point LiveSession::next() const {
  return begin_ + std::chrono::milliseconds(std::lround(1e3 * kStep_s)) * (steps_ + 1);
}

bool LiveSession::step(double most_s, const Onlooker& onlooker) {
  vehicle_->step();
  ++steps_;
  if (course_sent_s_ >= 0) result_.log.driven_m += std::abs(vehicle_->vehicle().state().speed_mps) * kStep_s;
  result_.log.mishap = vehicle_->mishap();
  take_plans(onlooker);
  if (course_sent_s_ >= 0 && steps_ % kStepsPerTurn == 0) write_step();
  return !has_ended(most_s);
}

void LiveSession::take_plans(const Onlooker& onlooker) {
  while (const auto sample = bus_.plan.take()) {
    const ipc::Plan& message = **sample;
    const bool is_sent = course_sent_s_ >= 0;
    if (is_sent && !talk_.is_of_course(message)) continue;
    plan_ = plan_of(message);
    layers_age_s_ = message.layers_age_s;
    if (!is_sent && talk_.is_ready(message)) send_course();
    if (!is_sent) continue;
    result_.cycle_ms.push_back(1e-6 * static_cast<double>(message.mono_published_ns - message.mono_begun_ns));
    if (onlooker) show(onlooker);
  }
}

void LiveSession::show(const Onlooker& onlooker) {
  if (const auto layers = bus_.layers.take_newest()) {
    copy(*layers, shown_.arrays());
    shown_grid_ = layers->header().grid;
    shown_stamp_ns_ = layers->header().header.stamp_ns;
  }
  if (!shown_stamp_ns_) return;
  const VehicleState& state = vehicle_->vehicle().state();
  onlooker({shown_.arrays(),
            shown_grid_,
            *shown_stamp_ns_,
            layers_age_s_,
            {vehicle_->odometry().stamp_ns, vehicle_->odometry().T_odom_base, state.speed_mps,
             state.curvature_per_m}},
           plan_);
}

void LiveSession::send_course() {
  static_cast<void>(bus_.course.publish(course_message(course_.waypoints_m), sim::kStartNs, 0));
  talk_.sent(ipc::monotonic_ns());
  course_sent_s_ = vehicle_->vehicle().time_s();
  plan_ = {};
  plan_.why = "the planner does not plan by the course that it was sent";
}

void LiveSession::write_step() {
  const Vehicle& vehicle = vehicle_->vehicle();
  const VehicleState& state = vehicle.state();
  DriveStep step{vehicle.time_s() - course_sent_s_,
                 vehicle.T_odom_base(),
                 state.place,
                 state.speed_mps,
                 state.curvature_per_m,
                 vehicle_->command(),
                 layers_age_s_,
                 0};
  step.nearest_m = obstacles_.nearest_m(vehicle.model().limits, state.place, vehicle.time_s());
  DriveLog& log = result_.log;
  log.add(step);
  log.bushes_driven_through = vehicle_->watch().bushes_driven_through();
  log.grass_driven_through = vehicle_->watch().grass_driven_through();
}

bool LiveSession::has_ended(double most_s) const {
  if (result_.log.mishap) return true;
  if (course_sent_s_ < 0) return vehicle_->vehicle().time_s() > most_s;
  const bool stands = std::abs(vehicle_->vehicle().state().speed_mps) < kStands_mps;
  const bool over = plan_.mode == planner::Mode::gave_up || (plan_.mode == planner::Mode::arrived && stands);
  return over || result_.log.seconds() > most_s;
}

SessionResult LiveSession::result() const {
  SessionResult result = result_;
  if (course_sent_s_ < 0)
    result.end =
        "the planner never planned by layers: " + (plan_.why.empty() ? "it said nothing" : plan_.why);
  else
    judge(plan_.mode, plan_.why, result);
  return result;
}

std::string LiveSession::figures() const {
  StreamCounts all;
  for (const auto& stream : streams_) {
    const StreamCounts counts = stream->counts();
    all.sent += counts.sent, all.late += counts.late, all.failed += counts.failed;
  }
  char text[200];
  std::snprintf(
      text, sizeof text,
      "%llu packets sent, %llu of them over %d ms late, %llu failed; %llu deadlines of commands passed",
      static_cast<unsigned long long>(all.sent), static_cast<unsigned long long>(all.late),
      static_cast<int>(LidarStream::kLate.count()), static_cast<unsigned long long>(all.failed),
      static_cast<unsigned long long>(vehicle_->deadlines_passed()));
  return text;
}

}  // namespace gvom::driving
