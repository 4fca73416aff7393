// Two rules as G-VOM's paper has them (Overbye and Saripalli, section III), for ablations.
#pragma once

#include <cstdint>
#include <vector>

#include "core/column.hpp"

namespace gvom::driving {

/// R9: a column's height is the lowest return of its lowest occupied voxel, whatever hangs, stands out or is
/// worn. Around the vehicle level ground is assumed. The paper knows no rims: all ground is one.
class PaperGround {
 public:
  explicit PaperGround(std::int32_t n_xy);

  /// Rewrites `height`, `visibility` and, in `flags`, ASSUMED. @param ours what core's R9 found; its rays
  /// stay
  /// @return the paper's ground, valid until the next call
  GroundView find(const FusedView& map, const ColumnParameters& p, const GroundView& ours,
                  const LayerArrays& out);

 private:
  float find_column(const FusedView& map, const ColumnParameters& p, std::int32_t x, std::int32_t y,
                    const LayerArrays& out) const;

  ColumnGrid grid_;
  std::vector<float> ground_m_;  // as GroundView has it, like the next
  std::vector<std::uint8_t> is_rim_;
};

/// R13: from each column without a height a cone is searched along +x, -x, +y and -y, as wide on each side as
/// it is far, up to `search_distance` columns. In each the nearest row with a height says the one that is
/// least to the side (of two the one at the lower index). NEGATIVE if the heights found differ by more than
/// `negative_threshold_m`. Beyond the grid there are none.
class PaperHoles {
 public:
  explicit PaperHoles(std::int32_t n_xy);

  /// Reads `height`, writes `negative_delta` and the flag NEGATIVE.
  void find(const LayersConfig& config, const LayerArrays& out);

 private:
  static constexpr std::int32_t kNowhere = 1 << 20;  // columns

  /// How far the nearest column with a height is from each along an axis, with its sign.
  void measure(const float* height_m, std::int32_t step, std::int32_t across, std::vector<std::int32_t>& to);
  /// Highest less lowest of what is found from a column; 0 if less than two are.
  [[nodiscard]] float delta_m(const float* height_m, std::int32_t x, std::int32_t y,
                              std::int32_t search_distance) const;

  std::int32_t n_;
  std::vector<std::int32_t> along_x_, along_y_;  // [y][x]
};

}  // namespace gvom::driving
