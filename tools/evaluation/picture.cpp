#include "tools/evaluation/picture.hpp"

#include <algorithm>
#include <cmath>

#include "tools/evaluation/picture_panels.hpp"

namespace gvom::evaluation {
namespace {

using snapshot::Canvas;
using snapshot::Rgb;
using snapshot::Swatch;

constexpr double kWanted_m = 8.0;  // before a hole

constexpr Rgb kHoleColour{196, 20, 40};
constexpr Rgb kTrunkColour{96, 58, 24};
constexpr Rgb kBushColour{60, 150, 66};
constexpr Rgb kGrassColour{178, 200, 92};
constexpr Rgb kRockColour{120, 120, 128};
constexpr Rgb kBuiltColour{70, 84, 140};
constexpr Rgb kFaceColour{240, 150, 50};
constexpr Rgb kOverhangColour{150, 190, 140};
constexpr Rgb kMirrorColour{110, 200, 230};
constexpr Rgb kDarkColour{60, 60, 66};
constexpr Rgb kWalkerColour{230, 90, 200};
constexpr Rgb kMissedColour{20, 110, 230};
constexpr Rgb kRightColour{226, 240, 222};
constexpr Rgb kOtherColour{246, 244, 238};

const std::vector<Swatch> kTruthLegend = {
    {kHoleColour, "hole"},       {kFaceColour, "face"},          {kTrunkColour, "trunk"},
    {kOverhangColour, "crown"},  {kBushColour, "bush"},          {kGrassColour, "grass"},
    {kRockColour, "rock"},       {kBuiltColour, "wall, car"},    {kMirrorColour, "water"},
    {kDarkColour, "no returns"}, {kWalkerColour, "walker's way"}};
const std::vector<Swatch> kErrorLegend = {
    {snapshot::kHardColour, "false HARD"},   {snapshot::kNegativeColour, "false NEGATIVE"},
    {snapshot::kSteepColour, "false STEEP"}, {kMissedColour, "lethal, missed"},
    {kRightColour, "drivable, and free"},    {kOtherColour, "not judged"},
    {snapshot::kUnknown, "not observed"}};

/// One column of the picture: its place in truth and map, -1 outside.
struct Place {
  std::int64_t truth;
  std::int64_t map;
};

Place place_of(const Truth& truth, const PanelWindow& window, int x, int y) {
  const auto [voxel_x, voxel_y] = window.voxel(x, y);
  const std::int64_t at_x = voxel_x - truth.origin[0], at_y = voxel_y - truth.origin[1];
  const bool outside = at_x < 0 || at_y < 0 || at_x >= truth.size_x || at_y >= truth.size_y;
  return {outside ? -1 : at_y * truth.size_x + at_x, window.in_frame(x, y)};
}

/// Light and shadow of the slope between neighbouring columns.
double relief(const std::vector<float>& height, std::int64_t at, int size_x, double edge_m) {
  if (at < size_x || at % size_x == 0) return 1.0;
  const double slope_x = (height[at] - height[at - 1]) / edge_m;
  const double slope_y = (height[at] - height[at - size_x]) / edge_m;
  return std::clamp(1.0 + 0.6 * (slope_x - slope_y), 0.5, 1.25);
}

Rgb class_colour(ObjectClass what) {
  switch (what) {
    case ObjectClass::tree:
      return kTrunkColour;
    case ObjectClass::bush:
      return kBushColour;
    case ObjectClass::rock:
      return kRockColour;
    case ObjectClass::ditch:
      return kHoleColour;
    case ObjectClass::step_face:
      return kFaceColour;
    case ObjectClass::overhang:
      return kOverhangColour;
    case ObjectClass::person:
      return kWalkerColour;
    case ObjectClass::grass:
      return kGrassColour;
    case ObjectClass::wall:
    case ObjectClass::car:
      return kBuiltColour;
    case ObjectClass::mirror:
      return kMirrorColour;
    case ObjectClass::dark:
      return kDarkColour;
    case ObjectClass::ground:
      break;
  }
  return snapshot::kPlainGround;
}

Rgb truth_colour(const Truth& truth, const Place& place) {
  if (place.truth < 0) return snapshot::kUnknown;
  const auto what = static_cast<ObjectClass>(truth.classes[place.truth]);
  if (what != ObjectClass::ground && what != ObjectClass::overhang) return class_colour(what);
  return shade(class_colour(what),
               relief(truth.ground_lowest, place.truth, truth.size_x, truth.resolution_m));
}

Rgb error_colour(const SceneFacts& facts, const Sight& sight, const Frame& frame, const Place& place) {
  const Truth& truth = facts.truth;
  if (place.map < 0 || place.truth < 0 || !is_observed(frame.visibility[place.map]))
    return snapshot::kUnknown;
  const std::uint8_t flags = frame.flags[place.map];
  if (truth.lethal[place.truth]) return flags & kLethalFlags ? kRightColour : kMissedColour;
  if (!truth.drivable[place.truth]) return kOtherColour;
  if (flags & kHard) return snapshot::kHardColour;
  if (flags & kNegative)
    return is_behind_edge(facts, frame, sight, static_cast<std::size_t>(place.truth))
               ? kOtherColour
               : snapshot::kNegativeColour;
  if (flags & kSteep) return snapshot::kSteepColour;
  return kRightColour;
}

}  // namespace

void InstructiveFrame::see(const Frame& frame) {
  const double off = facts_.holes.empty()
                         ? std::abs(seen_ - 0.5 * expected_)
                         : std::abs(facts_.holes.front().rim_driven_m - frame.driven_m - kWanted_m);
  ++seen_;
  if (off >= off_) return;
  off_ = off;
  const std::size_t count = static_cast<std::size_t>(frame.size) * frame.size;
  height_.assign(frame.height, frame.height + count);
  flags_.assign(frame.flags, frame.flags + count);
  visibility_.assign(frame.visibility, frame.visibility + count);
  frame_ = frame;
  frame_.height = height_.data();
  frame_.flags = flags_.data();
  frame_.visibility = visibility_.data();
}

Canvas draw_scene(const SceneFacts& facts, const Sight& sight, const Frame& frame, const std::string& title) {
  const Truth& truth = facts.truth;
  Canvas canvas = make_canvas(3, title);
  const PanelWindow window(frame, truth.resolution_m);
  draw_panel(canvas, 0, {"what is there", kTruthLegend}, window,
             paint_columns([&](int x, int y) { return truth_colour(truth, place_of(truth, window, x, y)); }));
  draw_panel(canvas, 1, {"what the map says", kMapLegend}, window,
             paint_columns([&](int x, int y) { return map_colour(window, x, y); }));
  draw_panel(canvas, 2, {"where it is wrong", kErrorLegend}, window, paint_columns([&](int x, int y) {
               return error_colour(facts, sight, frame, place_of(truth, window, x, y));
             }));
  return canvas;
}

}  // namespace gvom::evaluation
