// How the vehicle gets out of a dead end.
#pragma once

#include <cstdint>
#include <optional>

#include "services/planner/costmap.hpp"
#include "services/planner/follower.hpp"
#include "services/planner/trail.hpp"

namespace gvom::planner {

/// A vehicle that has stood for `kPatience_ns` without a trajectory backs along the way that it came, at most
/// `back_out_m` at a time, as far as it fits there.
class Retreat {
 public:
  static constexpr std::int64_t kPatience_ns = 1'000'000'000;
  static constexpr double kSpeed_mps = 1;

  explicit Retreat(const PlannerConfig& config) : config_(config) {}

  void forget();
  /// Each cycle: where the vehicle is.
  void observe(const Pose2& pose);
  [[nodiscard]] bool backs() const { return backs_; }
  [[nodiscard]] double backed_m() const { return backed_m_; }

  /// There is a trajectory.
  void clear() { blocked_since_ns_.reset(); }
  /// There is none. @return whether it backs from now on
  bool block(std::int64_t stamp_ns, bool stands, bool blind_behind);
  /// Backs from now on, if there is a way back that is worth it. @return whether it does
  bool begin(bool blind_behind);
  /// It backs no farther.
  void end() { backs_ = false; }
  /// The command to back by; nothing: that was all.
  std::optional<Command> back(const Costmap& costs, const Predicted& at);

 private:
  PlannerConfig config_;
  Trail trail_;
  std::optional<Pose2> last_;
  std::optional<std::int64_t> blocked_since_ns_;
  bool backs_ = false;
  double backed_m_ = 0;
};

}  // namespace gvom::planner
