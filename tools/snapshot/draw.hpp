// The parts that pictures are put together from.
#pragma once

#include "tools/snapshot/render.hpp"

namespace gvom::snapshot {

inline constexpr Rgb kPaper{255, 255, 255};
inline constexpr Rgb kInk{36, 38, 44};
inline constexpr Rgb kFaintInk{112, 116, 124};
inline constexpr Rgb kAlarm{208, 16, 24};

inline constexpr int kLegendWidth = 146;  ///< Right of the map, with its gap.
inline constexpr int kTitleHeight = 30;   ///< Above the map.
inline constexpr int kFooterHeight = 40;  ///< Below it: scale bar and axes.
inline constexpr int kHeaderHeight = 74;

/// Title, map, vehicle, legend, scale bar, axes. The room around `area` must be there.
void draw_panel(Canvas& canvas, const MapArea& area, const LayersPicture& picture, const Panel& panel);

/// Two lines from `left`: vehicle, stamp, age, pose; then the lidars, missing ones in red.
void draw_header(Canvas& canvas, double left, const LayersPicture& picture);

}  // namespace gvom::snapshot
