#include "tools/evaluation/picture.hpp"

#include <algorithm>
#include <cmath>

#include "tools/snapshot/draw.hpp"

namespace gvom::evaluation {
namespace {

using snapshot::Canvas;
using snapshot::Point;
using snapshot::Rgb;
using snapshot::Swatch;

constexpr int kHalf = 90;  // columns shown to either side of the vehicle
constexpr int kShown = 2 * kHalf;
constexpr int kZoom = 4;
constexpr int kMargin = 24;
constexpr int kTop = 84;
constexpr int kLegend = 64;
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
const std::vector<Swatch> kMapLegend = {{snapshot::kHardColour, "HARD"},
                                        {snapshot::kSoftColour, "SOFT"},
                                        {snapshot::kNegativeColour, "NEGATIVE"},
                                        {snapshot::kSteepColour, "STEEP"},
                                        {snapshot::kSeenThrough, "no ground found"},
                                        {snapshot::kUnknown, "not observed"}};
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

class Window {
 public:
  Window(const SceneFacts& facts, const Frame& frame) : truth_(facts.truth), frame_(frame) {
    const double edge_m = truth_.resolution_m;
    for (int axis = 0; axis < 2; ++axis)
      first_[axis] = static_cast<std::int64_t>(std::floor(frame.base_m[axis] / edge_m)) - kHalf;
  }

  [[nodiscard]] Place place(int x, int y) const {
    return {inside(x, y, truth_.origin[0], truth_.origin[1], truth_.size_x, truth_.size_y),
            inside(x, y, frame_.origin[0], frame_.origin[1], frame_.size, frame_.size)};
  }
  /// Pixels of a point, in a panel whose left edge is at `left`.
  [[nodiscard]] Point pixel(const Eigen::Vector2d& point_m, int left) const {
    const double x = point_m.x() / truth_.resolution_m - static_cast<double>(first_[0]);
    const double y = point_m.y() / truth_.resolution_m - static_cast<double>(first_[1]);
    return {left + x * kZoom, kTop + (kShown - y) * kZoom};
  }

 private:
  [[nodiscard]] std::int64_t inside(int x, int y, std::int64_t origin_x, std::int64_t origin_y, int size_x,
                                    int size_y) const {
    const std::int64_t at_x = first_[0] + x - origin_x, at_y = first_[1] + y - origin_y;
    return at_x < 0 || at_y < 0 || at_x >= size_x || at_y >= size_y ? -1 : at_y * size_x + at_x;
  }

  const Truth& truth_;
  const Frame& frame_;
  std::int64_t first_[2] = {};
};

/// Light and shadow of the slope between neighbouring columns.
double relief(const std::vector<float>& height, std::int64_t at, int size_x, double edge_m) {
  if (at < size_x || at % size_x == 0) return 1.0;
  const double slope_x = (height[at] - height[at - 1]) / edge_m;
  const double slope_y = (height[at] - height[at - size_x]) / edge_m;
  return std::clamp(1.0 + 0.6 * (slope_x - slope_y), 0.5, 1.25);
}

Rgb shade(Rgb colour, double light) {
  const auto part = [light](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value * light, 0.0, 255.0)));
  };
  return {part(colour.r), part(colour.g), part(colour.b)};
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

Rgb map_colour(const Truth& truth, const Frame& frame, const Place& place) {
  if (place.map < 0 || !is_observed(frame.visibility[place.map])) return snapshot::kUnknown;
  const std::uint8_t flags = frame.flags[place.map];
  if (flags & kHard) return snapshot::kHardColour;
  if (flags & kNegative) return snapshot::kNegativeColour;
  if (flags & kSteep) return snapshot::kSteepColour;
  if (flags & kSoft) return snapshot::kSoftColour;
  if (std::isnan(frame.height[place.map])) return snapshot::kSeenThrough;
  if (place.map < frame.size || place.map % frame.size == 0) return snapshot::kPlainGround;
  const double slope_x = (frame.height[place.map] - frame.height[place.map - 1]) / truth.resolution_m;
  return std::isnan(slope_x) ? snapshot::kPlainGround
                             : shade(snapshot::kPlainGround, std::clamp(1.0 + 0.6 * slope_x, 0.5, 1.25));
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

template <typename ColourOf>
void draw_columns(Canvas& canvas, int left, const Window& window, ColourOf colour_of) {
  std::vector<Rgb> colours;
  for (int y = 0; y < kShown; ++y)
    for (int x = 0; x < kShown; ++x) colours.push_back(colour_of(window.place(x, y)));
  canvas.blocks(left, kTop, kZoom, kShown, colours);
  canvas.outline({static_cast<double>(left), kTop}, kShown * kZoom, kShown * kZoom, snapshot::kFaintInk);
}

void draw_vehicle(Canvas& canvas, int left, const Window& window, const Frame& frame) {
  const Eigen::Vector2d side(-frame.forward.y(), frame.forward.x());
  const auto at = [&](double along_m, double beside_m) {
    return window.pixel(frame.base_m + along_m * frame.forward + beside_m * side, left);
  };
  canvas.polygon({at(1.4, 0.0), at(-0.8, 0.8), at(-0.8, -0.8)}, snapshot::kPaper, snapshot::kInk);
}

void draw_legend(Canvas& canvas, int left, const std::vector<Swatch>& swatches) {
  double x = left, y = kTop + kShown * kZoom + 26;
  for (const Swatch& swatch : swatches) {
    if (x > left + kShown * kZoom - 140) {
      x = left;
      y += 22;
    }
    canvas.rectangle({x, y - 11}, 14, 14, swatch.colour);
    x = canvas.text({x + 20, y}, swatch.label, {13, snapshot::kInk}) + 18;
  }
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
  constexpr int kPanel = kShown * kZoom + kMargin;
  Canvas canvas(kMargin + 3 * kPanel, kTop + kShown * kZoom + kLegend, snapshot::kPaper);
  canvas.text({kMargin, 34}, title, {22, snapshot::kInk, true});
  const Window window(facts, frame);
  const Truth& truth = facts.truth;
  const auto panel = [&](int number, const char* name, const std::vector<Swatch>& legend, auto colour_of) {
    const int left = kMargin + number * kPanel;
    canvas.text({static_cast<double>(left), kTop - 14}, name, {16, snapshot::kInk, true});
    draw_columns(canvas, left, window, colour_of);
    draw_vehicle(canvas, left, window, frame);
    draw_legend(canvas, left, legend);
  };
  panel(0, "what is there", kTruthLegend, [&](const Place& p) { return truth_colour(truth, p); });
  panel(1, "what the map says", kMapLegend, [&](const Place& p) { return map_colour(truth, frame, p); });
  panel(2, "where it is wrong", kErrorLegend,
        [&](const Place& p) { return error_colour(facts, sight, frame, p); });
  return canvas;
}

}  // namespace gvom::evaluation
