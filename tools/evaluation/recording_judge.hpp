// Maps of real recordings, against what little is known of the place.
#pragma once

#include "tools/evaluation/figures.hpp"
#include "tools/evaluation/frame.hpp"
#include "tools/evaluation/known_columns.hpp"
#include "tools/evaluation/tally.hpp"

namespace gvom::evaluation {

class RecordingJudge {
 public:
  /// `known` must outlive this.
  explicit RecordingJudge(const KnownColumns& known) : known_(known) {}

  void add(const Frame& frame);
  [[nodiscard]] Figures result() const;

 private:
  void judge(std::uint8_t flags, double ahead_m, Known known);

  const KnownColumns& known_;
  ShareByRange observed_negative_, negative_, hard_, steep_, lethal_;
  Share trees_found_, trees_hard_, bushes_soft_;
};

}  // namespace gvom::evaluation
