#include "tools/snapshot/panel.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::snapshot {
namespace {

constexpr double kDegrees = 57.29577951308232;
constexpr double kMinHeightSpan_m = 2.0;

double largest_finite(const float* values, std::size_t count, double at_least) {
  double largest = at_least;
  for (std::size_t i = 0; i < count; ++i)
    if (std::isfinite(values[i])) largest = std::max(largest, static_cast<double>(values[i]));
  return largest;
}

Visibility visibility_of(const LayersPicture& picture, std::size_t column) {
  return static_cast<Visibility>(picture.bytes(LayerId::visibility)[column]);
}

std::string count_label(const char* name, std::size_t count) {
  return name + ("  " + std::to_string(count));
}

/// A float layer on one colour bar, values times `factor`.
Panel continuous(LayerId layer, const LayersPicture& picture, const Bar& bar, double factor = 1.0) {
  const float* values = picture.floats(layer);
  Panel panel;
  panel.columns = paint(picture, [&](std::size_t i) {
    return std::isnan(values[i]) ? kUnknown : bar.map->at(bar.scale.fraction(values[i] * factor));
  });
  panel.bars = {bar};
  panel.swatches = {{kUnknown, "unknown"}};
  return panel;
}

Panel height_panel(LayerId layer, const LayersPicture& picture) {
  const Scale scale = robust_scale(picture.floats(layer), picture.columns(), kMinHeightSpan_m);
  return continuous(layer, picture, {"", &kDepths, scale});
}

Panel signed_slope(LayerId layer, const LayersPicture& picture) {
  const Scale found = robust_scale(picture.floats(layer), picture.columns(), 0.4);
  const double limit = std::max(std::abs(found.low), std::abs(found.high));
  return continuous(layer, picture, {"", &kDiverging, {-limit, limit}});
}

Panel obstacles(const LayersPicture& picture) {
  const float* density = picture.floats(LayerId::obstacle_density);
  const std::uint8_t* flags = picture.bytes(LayerId::flags);
  Panel panel;
  panel.columns = paint(picture, [&](std::size_t i) {
    if (flags[i] & kHard) return kReds.at(density[i]);
    if (flags[i] & kSoft) return kGreens.at(density[i]);
    return std::isnan(density[i]) ? kUnknown : kPlainGround;
  });
  panel.bars = {{"hard", &kReds, {0, 1}}, {"soft", &kGreens, {0, 1}}};
  panel.swatches = {{kPlainGround, "no obstacle"}, {kUnknown, "unknown"}};
  return panel;
}

Panel negative_obstacles(const LayersPicture& picture) {
  const float* delta = picture.floats(LayerId::negative_delta);
  const float* height = picture.floats(LayerId::height);
  const std::uint8_t* flags = picture.bytes(LayerId::flags);
  const Scale scale{0, std::min(10.0, largest_finite(delta, picture.columns(), 2.0))};
  Panel panel;
  panel.columns = paint(picture, [&](std::size_t i) {
    if (flags[i] & kNegative) return kViolets.at(scale.fraction(delta[i]));
    const Visibility seen = visibility_of(picture, i);
    if (seen == Visibility::unobserved) return kUnknown;
    const bool has_ground =
        seen == Visibility::remembered ? !std::isnan(height[i]) : seen != Visibility::free_only;
    if (has_ground) return kPlainGround;
    return delta[i] > 0.0F ? kAssumedColour : kSeenThrough;
  });
  panel.bars = {{"drop", &kViolets, scale}};
  panel.swatches = {{kAssumedColour, "small drop"},
                    {kSeenThrough, "seen through"},
                    {kPlainGround, "ground"},
                    {kUnknown, "unknown"}};
  return panel;
}

Panel clearance(const LayersPicture& picture) {
  const float* values = picture.floats(LayerId::clearance);
  const Scale scale{0, std::max(6.0, robust_scale(values, picture.columns(), 0.0).high)};
  Panel panel;
  panel.columns = paint(picture, [&](std::size_t i) {
    if (std::isnan(values[i])) return kUnknown;
    return std::isinf(values[i]) ? kOpenSky : kLowRoof.at(scale.fraction(values[i]));
  });
  panel.bars = {{"", &kLowRoof, scale}};
  panel.swatches = {{kOpenSky, "open above"}, {kUnknown, "unknown"}};
  return panel;
}

Panel discrete(const LayersPicture& picture, const std::uint8_t* values, const std::vector<Swatch>& classes) {
  std::vector<std::size_t> counts(classes.size(), 0);
  Panel panel;
  panel.columns = paint(picture, [&](std::size_t i) {
    const std::size_t value = std::min<std::size_t>(values[i], classes.size() - 1);
    ++counts[value];
    return classes[value].colour;
  });
  for (std::size_t i = classes.size(); i-- > 0;)
    panel.swatches.push_back({classes[i].colour, count_label(classes[i].label.c_str(), counts[i])});
  return panel;
}

/// A column with several flags shows the first of these.
struct FlagColour {
  std::uint8_t bit;
  Rgb colour;
  const char* name;
};
constexpr FlagColour kFlagColours[] = {{kNegative, kNegativeColour, "NEGATIVE"},
                                       {kHard, kHardColour, "HARD"},
                                       {kSteep, kSteepColour, "STEEP"},
                                       {kSoft, kSoftColour, "SOFT"},
                                       {kAssumed, kAssumedColour, "ASSUMED"}};

Panel flags_panel(const LayersPicture& picture) {
  const std::uint8_t* flags = picture.bytes(LayerId::flags);
  Panel panel;
  panel.columns = paint(picture, [&](std::size_t i) {
    for (const FlagColour& flag : kFlagColours)
      if (flags[i] & flag.bit) return flag.colour;
    return visibility_of(picture, i) == Visibility::unobserved ? kUnknown : kPlainGround;
  });
  for (const FlagColour& flag : kFlagColours) {
    const auto count =
        std::count_if(flags, flags + picture.columns(), [&](std::uint8_t f) { return f & flag.bit; });
    panel.swatches.push_back({flag.colour, count_label(flag.name, static_cast<std::size_t>(count))});
  }
  panel.swatches.push_back({kPlainGround, "none"});
  panel.swatches.push_back({kUnknown, "unobserved"});
  return panel;
}

Panel cost_panel(const LayersPicture& picture) {
  constexpr std::uint8_t kUnknownCost = 255;
  constexpr std::uint8_t kHighestCost = 252;
  const std::uint8_t* cost = picture.bytes(LayerId::cost);
  const Scale scale{0, kHighestCost};
  Panel panel;
  panel.columns = paint(picture, [&](std::size_t i) {
    if (cost[i] == kUnknownCost) return kUnknown;
    return cost[i] > kHighestCost ? kLethal : kTraffic.at(scale.fraction(cost[i]));
  });
  panel.bars = {{"", &kTraffic, scale}};
  panel.swatches = {{kLethal, "254 lethal"}, {kUnknown, "255 unknown"}};
  return panel;
}

Panel coloured(LayerId layer, const LayersPicture& picture) {
  const auto count = picture.columns();
  switch (layer) {
    case LayerId::height:
    case LayerId::inferred_height:
      return height_panel(layer, picture);
    case LayerId::slope_x:
    case LayerId::slope_y:
      return signed_slope(layer, picture);
    case LayerId::slope:
      return continuous(layer, picture, {"", &kHeat, {0, 45}}, kDegrees);
    case LayerId::roughness:
      return continuous(layer, picture, {"", &kHeat, {1e-5, 1, true}});
    case LayerId::obstacle_density:
      return obstacles(picture);
    case LayerId::negative_delta:
      return negative_obstacles(picture);
    case LayerId::clearance:
      return clearance(picture);
    case LayerId::last_seen:
      return continuous(layer, picture,
                        {"", &kFreshness, {0, largest_finite(picture.floats(layer), count, 0.5)}});
    case LayerId::flags:
      return flags_panel(picture);
    case LayerId::visibility:
      return discrete(picture, picture.bytes(layer),
                      {{kUnknown, "unobserved"},
                       {kSeenThrough, "free only"},
                       {kAssumedColour, "assumed"},
                       {{96, 158, 92}, "ground"},
                       {{150, 178, 120}, "remembered"}});
    case LayerId::cost:
      break;
  }
  return cost_panel(picture);
}

struct Heading {
  const char* title;
  const char* unit;
};
constexpr std::array<Heading, kLayers> kHeadings = {{
    {"Height of the ground", "m, odom"},
    {"Inferred height: ground is at most", "m, odom"},
    {"Slope along x", "m/m"},
    {"Slope along y", "m/m"},
    {"Slope", "degrees"},
    {"Roughness", "m², logarithmic"},
    {"Obstacles", "density"},
    {"Negative obstacles", "m"},
    {"Clearance overhead", "m"},
    {"Last seen", "s before the stamp"},
    {"Flags", "columns"},
    {"Visibility", "columns"},
    {"Cost", "costmap, 0 .. 252"},
}};

}  // namespace

Panel make_panel(LayerId layer, const LayersPicture& picture) {
  Panel panel = coloured(layer, picture);
  const auto index = static_cast<std::size_t>(layer);
  panel.name = kLayerNames[index];
  panel.title = kHeadings[index].title;
  panel.unit = kHeadings[index].unit;
  return panel;
}

}  // namespace gvom::snapshot
