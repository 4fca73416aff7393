// One drive of a course by the reference planner, and what came of it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/vehicle_config.hpp"
#include "tools/drive/drive_log.hpp"
#include "tools/drive/loop.hpp"
#include "tools/drive/truth_planner.hpp"
#include "tools/drive/worlds.hpp"

namespace gvom::driving {

struct SessionOptions {
  sim::Sensor sensor = sim::Sensor::os1_64;
  sim::OdometryNoise odometry_noise{0.02, 0.002};
  Ablation ablation = Ablation::none;
  std::uint64_t seed = 1;
  int threads = 1;
  double patience = 6;  ///< Times the truth planner's time, and a minute, it may take.
};

enum class Outcome : std::uint8_t { arrived, mishap, gave_up, too_slow };
const char* words_of(Outcome outcome);

/// Of a whole drive.
struct SessionResult {
  Outcome outcome = Outcome::too_slow;
  std::string end;             ///< In words: the mishap, or what the planner said last.
  std::optional<TrueWay> way;  ///< Of one who knows the world; nothing: there is none.
  DriveLog log;
  int false_stops = 0;  ///< Times that it stood for over a second before its end.
  double top_speed_mps = 0;
  std::vector<double> cycle_ms;  ///< Of the planner, each: of the processor, by the clock if in real time.
};

/// What a vehicle's lidars are: OS1-128 if the first has room for just its returns (`max_returns` 131072),
/// else OS1-64.
sim::Sensor sensor_of(const services::VehicleConfig& config);

// What sessions in lock-step and in real time have in common.
Rig rig_of(const services::VehicleConfig& config, sim::Sensor sensor);
std::optional<TrueWay> true_way(const sim::GroundTruth& truth, const CourseWorld& course,
                                const planner::PlannerConfig& planning);
/// How long a drive may take, seconds.
double most_seconds(const SessionOptions& options, const std::optional<TrueWay>& way);
/// Fills in the result by its log and what the planner said last.
void judge(planner::Mode mode, const std::string& why, SessionResult& result);

/// Is shown each turn's plan with what it was made of.
using Onlooker = std::function<void(const Seen&, const planner::Plan&)>;

/// Errors: what could not be simulated or mapped.
tl::expected<SessionResult, std::string> run_session(const CourseWorld& course,
                                                     const services::VehicleConfig& config,
                                                     const SessionOptions& options,
                                                     const Onlooker& onlooker = {});

}  // namespace gvom::driving
