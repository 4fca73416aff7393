// Things: whether trunks, walls, cars and rocks are HARD, and bushes SOFT.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/evaluation/figures.hpp"
#include "tools/evaluation/scene_facts.hpp"
#include "tools/evaluation/tally.hpp"

namespace gvom::evaluation {

class ObjectJudge {
 public:
  /// `facts` must outlive this.
  explicit ObjectJudge(const SceneFacts& facts);

  /// What no straight line from the sensor reaches does not count.
  void add(const Frame& frame, const Sight& sight);
  void fill(Figures& figures) const;

 private:
  void judge_trunks(const Frame& frame, const Sight& sight);
  void judge_solid(const Frame& frame, const Sight& sight, std::size_t column, std::uint8_t flags);
  void judge_bush(std::size_t column, std::uint8_t flags);
  [[nodiscard]] Share* share_of(std::size_t column);

  const SceneFacts& facts_;
  std::vector<char> trunk_was_near_, trunk_was_hard_;  // while it was near
  Share trunks_near_, trunks_far_;
  Share walls_, cars_, rocks_;
  Share bushes_found_, bushes_soft_, bushes_hard_, crown_bushes_soft_, crown_bushes_hard_;
};

}  // namespace gvom::evaluation
