#include "tools/evaluation/recording_judge.hpp"

namespace gvom::evaluation {

void RecordingJudge::add(const Frame& frame) {
  for (int y = 0; y < frame.size; ++y)
    for (int x = 0; x < frame.size; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * frame.size + x;
      if (!is_observed(frame.visibility[at])) continue;
      const KnownColumns::Voxel voxel{frame.origin[0] + x, frame.origin[1] + y};
      judge(frame.flags[at], frame.ahead_m(known_.middle_of(voxel)), known_.at(voxel));
    }
}

void RecordingJudge::judge(std::uint8_t flags, double ahead_m, Known known) {
  observed_negative_.count(ahead_m, flags & kNegative);
  switch (known) {
    case Known::nothing:
      break;
    case Known::drivable:
      negative_.count(ahead_m, flags & kNegative);
      hard_.count(ahead_m, flags & kHard);
      steep_.count(ahead_m, flags & kSteep);
      lethal_.count(ahead_m, flags & kLethalFlags);
      break;
    case Known::tree:
      trees_found_.count(flags & kObstacleFlags);
      if (flags & kObstacleFlags) trees_hard_.count(flags & kHard);
      break;
    case Known::bush:
      bushes_soft_.count((flags & kHard) == 0);
      break;
  }
}

Figures RecordingJudge::result() const {
  Figures figures;
  const auto put = [&](const ShareByRange& shares, Figure near, Figure far, Figure any) {
    figures[near] = shares.near.percent();
    figures[far] = shares.far.percent();
    figures[any] = shares.any.percent();
  };
  put(observed_negative_, Figure::observed_negative_near, Figure::observed_negative_30,
      Figure::observed_negative_any);
  put(negative_, Figure::negative_near, Figure::negative_30, Figure::negative_any);
  put(hard_, Figure::hard_near, Figure::hard_30, Figure::hard_any);
  put(steep_, Figure::steep_near, Figure::steep_30, Figure::steep_any);
  put(lethal_, Figure::lethal_near, Figure::lethal_30, Figure::lethal_any);
  figures[Figure::real_trees_found] = trees_found_.percent();
  figures[Figure::real_trees_hard] = trees_hard_.percent();
  figures[Figure::real_bushes_soft] = bushes_soft_.percent();
  return figures;
}

}  // namespace gvom::evaluation
