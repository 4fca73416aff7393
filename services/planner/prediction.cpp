#include "services/planner/prediction.hpp"

#include <algorithm>
#include <cmath>

#include "services/planner/arc.hpp"

namespace gvom::planner {

Prediction::Prediction(const PlannerConfig& config) : config_(config) {
  commands_.resize(static_cast<std::size_t>(std::ceil(config.vehicle.latency_s * config.rate_hz - 1e-9)));
  way_.reserve(commands_.size());
}

void Prediction::forget() {
  std::fill(commands_.begin(), commands_.end(), Command{});
}

void Prediction::add(const Command& command) {
  if (commands_.empty()) return;
  std::rotate(commands_.begin(), commands_.begin() + 1, commands_.end());
  commands_.back() = command;
}

const Predicted& Prediction::from(const Predicted& now) {
  const VehicleLimits& vehicle = config_.vehicle;
  const double period_s = 1 / config_.rate_hz;
  way_.clear();
  predicted_ = now;
  for (const Command& command : commands_) {
    const double before_mps = predicted_.speed_mps;
    const bool faster = std::abs(command.speed_mps) > std::abs(before_mps);
    const double most_mps = period_s * (faster ? vehicle.max_accel_mps2 : vehicle.max_decel_mps2);
    const double turn_per_m = period_s * vehicle.max_curvature_rate_per_m_s;
    predicted_.speed_mps += std::clamp(command.speed_mps - before_mps, -most_mps, most_mps);
    predicted_.curvature_per_m +=
        std::clamp(command.curvature_per_m - predicted_.curvature_per_m, -turn_per_m, turn_per_m);
    const double length_m = period_s * (before_mps + predicted_.speed_mps) / 2;
    predicted_.pose = moved(predicted_.pose, length_m, predicted_.curvature_per_m);
    way_.push_back(predicted_.pose);
  }
  return predicted_;
}

}  // namespace gvom::planner
