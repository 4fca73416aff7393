#include <algorithm>
#include <cmath>

#include "tools/snapshot/panel.hpp"

namespace gvom::snapshot {
namespace {

constexpr double kMinHeightSpan_m = 4.0;

Rgb shaded(Rgb colour, double light) {
  const auto scaled = [light](std::uint8_t c) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(c * light, 0.0, 255.0)));
  };
  return {scaled(colour.r), scaled(colour.g), scaled(colour.b)};
}

/// How bright a slope is under a light from the upper left, 1 on level ground.
double relief(float slope_x, float slope_y) {
  if (std::isnan(slope_x) || std::isnan(slope_y)) return 1.0;
  constexpr double kExaggeration = 1.5;
  const double a = kExaggeration * slope_x;
  const double b = kExaggeration * slope_y;
  const double facing = (1.0 + (a - b) / std::sqrt(2.0)) / std::sqrt(1.0 + a * a + b * b);
  return std::clamp(facing, 0.35, 1.3);
}

}  // namespace

Panel make_overview(const LayersPicture& picture) {
  static constexpr Rgb kTerrainStops[] = {
      {126, 92, 70}, {176, 138, 98}, {214, 184, 134}, {240, 220, 170}, {255, 246, 214}};
  static constexpr ColourMap kTerrain{kTerrainStops, std::size(kTerrainStops)};
  const float* height = picture.floats(LayerId::height);
  const float* slope_x = picture.floats(LayerId::slope_x);
  const float* slope_y = picture.floats(LayerId::slope_y);
  const std::uint8_t* flags = picture.bytes(LayerId::flags);
  const Scale scale = robust_scale(height, picture.columns(), kMinHeightSpan_m);
  Panel panel;
  panel.name = "overview";
  panel.title = "Overview: relief and obstacles";
  panel.unit = "m, odom";
  panel.columns = paint(picture, [&](std::size_t i) {
    if (flags[i] & kHard) return kHardColour;
    if (flags[i] & kNegative) return kNegativeColour;
    if (flags[i] & kSoft) return kSoftColour;
    if (std::isnan(height[i])) return kUnknown;
    return shaded(kTerrain.at(scale.fraction(height[i])), relief(slope_x[i], slope_y[i]));
  });
  panel.bars = {{"", &kTerrain, scale}};
  panel.swatches = {
      {kHardColour, "hard"}, {kSoftColour, "soft"}, {kNegativeColour, "negative"}, {kUnknown, "no ground"}};
  return panel;
}

}  // namespace gvom::snapshot
