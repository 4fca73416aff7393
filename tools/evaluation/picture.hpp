// A scene as a picture: what is there, what the map says, and where that is wrong.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/evaluation/frame.hpp"
#include "tools/evaluation/scene_facts.hpp"
#include "tools/snapshot/canvas.hpp"

namespace gvom::evaluation {

/// Keeps the most instructive of the maps that it is shown: 8 m before the first hole, else half-way.
class InstructiveFrame {
 public:
  /// @param expected how many maps will be shown
  InstructiveFrame(const SceneFacts& facts, int expected) : facts_(facts), expected_(expected) {}
  InstructiveFrame(const InstructiveFrame&) = delete;
  InstructiveFrame& operator=(const InstructiveFrame&) = delete;

  void see(const Frame& frame);
  [[nodiscard]] bool empty() const { return flags_.empty(); }
  [[nodiscard]] const Frame& frame() const { return frame_; }

 private:
  const SceneFacts& facts_;
  int expected_;
  int seen_ = 0;
  double off_ = HUGE_VAL;  // by how much the kept one is not what is wanted
  Frame frame_;
  std::vector<float> height_;
  std::vector<std::uint8_t> flags_, visibility_;
};

/// Three panels of the 72 m around the vehicle, +x to the right: the truth, the map, the errors; with a
/// legend.
snapshot::Canvas draw_scene(const SceneFacts& facts, const Sight& sight, const Frame& frame,
                            const std::string& title);

}  // namespace gvom::evaluation
