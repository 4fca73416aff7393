// The process that plans: layers, odometry and a course in, plans and commands out.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ipc/fixed.hpp"
#include "ipc/layers.hpp"
#include "ipc/runtime.hpp"
#include "ipc/waiter.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/health.hpp"
#include "services/common/lifecycle.hpp"
#include "services/common/log.hpp"
#include "services/common/vehicle_config.hpp"
#include "services/planner/planner.hpp"
#include "services/planner/process/course_record.hpp"
#include "services/planner/process/motion.hpp"
#include "services/planner/process/sides.hpp"

namespace gvom::planner {

/// This process's ends of the topics.
struct Bus {
  ipc::Waiter waiter;
  ipc::LayersSubscriber layers;
  ipc::Subscriber<ipc::Odometry> odometry;
  ipc::Subscriber<ipc::Course> course;
  ipc::Publisher<ipc::Plan> plan;
  ipc::Publisher<ipc::Command> command;
  ipc::Publisher<ipc::Health> health;

  static ipc::Expected<Bus> open(ipc::Runtime& runtime);
};

/// Plans at `planner.rate_hz`, by CLOCK_MONOTONIC, whatever comes or does not come: a command to stand still
/// is one, too. When it dies, commands end, and the vehicle stops at the last one's deadline.
class PlannerNode {
 public:
  /// All references outlive the node.
  PlannerNode(const services::VehicleConfig& config, ipc::Runtime& runtime, Bus& bus,
              services::Lifecycle& lifecycle, const std::vector<Eigen::Vector2d>& course);
  ~PlannerNode();

  /// Until a stop.
  services::ExitCode run();

 private:
  struct Counts {
    std::uint64_t cycles = 0, overruns = 0, stops = 0;
    std::uint64_t layers_in = 0, odometry_in = 0, courses_in = 0;
    std::uint64_t bad_odometry = 0, odometry_jumps = 0, without_chunk = 0;
  };

  void take_odometry();
  void take_course();
  void follow(std::vector<Eigen::Vector2d> course, const CourseName& name);
  void take_layers();
  void cycle(std::int64_t begun_ns);
  /// What to do now. Valid until the next call.
  const Plan& decide(std::int64_t now_ns);
  /// Whether the layers are of this motion: neither from before a jump, nor by a clock that was set back.
  [[nodiscard]] bool layers_fit(const State& state) const;
  [[nodiscard]] Senses look() const;
  void publish(const Plan& plan, std::int64_t begun_ns);
  void command(const Plan& plan);
  void tell(const Plan& plan);
  void publish_health();

  const services::VehicleConfig& config_;
  Bus& bus_;
  services::Lifecycle& lifecycle_;
  services::BrokerWatch broker_;
  services::HealthReport health_;
  services::StageHistogram& cycle_stage_;
  services::LogEvery log_drops_{std::chrono::seconds(10)};
  Counts counts_;
  std::vector<std::pair<std::uint64_t*, const std::uint64_t*>> counters_;  // of Health, and where they are

  Planner planner_;
  MotionEstimate motion_;
  Sides sides_;
  std::vector<Eigen::Vector2d> course_;
  CourseName course_name_;
  CourseRecord record_;
  std::optional<ipc::LayersSample> layers_;
  std::int64_t odometry_ns_ = 0;        // when the newest pose came
  bool jumped_ = false;                 // since the last cycle
  std::int64_t jump_stamp_ns_ = 0;      // layers from before it are not driven by
  std::int64_t took_ns_ = 0;            // the last cycle
  std::unique_ptr<ipc::Plan> message_;  // of the plan: large
  std::uint32_t told_reason_ = ~0U;     // in the log
};

}  // namespace gvom::planner
