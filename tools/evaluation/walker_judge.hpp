// Walkers: whether they are seen, and how long they leave ghosts behind.
#pragma once

#include <vector>

#include "tools/evaluation/figures.hpp"
#include "tools/evaluation/scene_facts.hpp"
#include "tools/evaluation/tally.hpp"

namespace gvom::evaluation {

class WalkerJudge {
 public:
  /// `facts` must outlive this.
  explicit WalkerJudge(const SceneFacts& facts);

  /// Frames in order of time. What is not near and observed is not judged.
  void add(const Frame& frame);
  void fill(Figures& figures) const;

 private:
  struct Left {
    std::size_t column;
    double left_s;         // the last moment at which the walker was there
    double ghost_s = 0.0;  // from then to the last frame in which the column was an obstacle
    bool judged = false;   // since then
  };
  /// Where a walker goes: the columns in which nothing else stands.
  struct Way {
    const sim::Object* walker;
    std::vector<Left> columns;
  };

  void judge_presence(const Frame& frame, const sim::Object& walker);

  const SceneFacts& facts_;
  std::vector<Way> ways_;
  Share found_;
};

}  // namespace gvom::evaluation
