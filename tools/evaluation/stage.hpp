// A scene made ready to be driven through at a speed: its world, its truth, the way.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/evaluation/scene_facts.hpp"
#include "tools/sim/scene_library.hpp"
#include "tools/sim/trajectory.hpp"
#include "tools/sim/world.hpp"

namespace gvom::evaluation {

struct StageOptions {
  sim::SceneParameters scene;
  double base_height_m = 0.0;  ///< Of base_link above the ground (R9).
  double resolution_m = 0.4;   ///< Of the map's columns.
};

class Stage {
 public:
  /// Errors: there is no such scene.
  static tl::expected<std::unique_ptr<Stage>, std::string> set(const std::string& scene,
                                                               const StageOptions& options);
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  [[nodiscard]] const sim::World& world() const { return world_; }
  [[nodiscard]] const sim::Trajectory& trajectory() const { return trajectory_; }
  [[nodiscard]] const Truth& truth() const { return truth_; }
  [[nodiscard]] const SceneFacts& facts() const { return facts_; }
  [[nodiscard]] double speed_mps() const { return speed_mps_; }
  [[nodiscard]] std::uint64_t world_key() const { return world_key_; }  ///< See `key_of`.
  /// Against what is solid and stands still: no leaves, no drops, no walkers. Valid while this lives.
  [[nodiscard]] Sight sight() const;

 private:
  Stage(sim::WorldData data, const StageOptions& options);

  double speed_mps_;
  std::uint64_t world_key_;
  sim::World world_;
  sim::World solid_;
  sim::Trajectory trajectory_;
  Truth truth_;
  SceneFacts facts_;
};

}  // namespace gvom::evaluation
