#include "tools/evaluation/picture_panels.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::evaluation {

using snapshot::Canvas;
using snapshot::Point;
using snapshot::Rgb;
using snapshot::Swatch;

namespace {

constexpr int kSide = kShownColumns * kColumnPixels;
constexpr int kLegend = 64;

void draw_vehicle(Canvas& canvas, int left, const PanelWindow& window) {
  const Frame& frame = window.frame();
  const Eigen::Vector2d side(-frame.forward.y(), frame.forward.x());
  const auto at = [&](double along_m, double beside_m) {
    return window.pixel(frame.base_m + along_m * frame.forward + beside_m * side, left);
  };
  canvas.polygon({at(1.4, 0.0), at(-0.8, 0.8), at(-0.8, -0.8)}, snapshot::kPaper, snapshot::kInk);
}

void draw_legend(Canvas& canvas, int left, const std::vector<Swatch>& swatches) {
  double x = left, y = kPanelTop + kSide + 26;
  for (const Swatch& swatch : swatches) {
    if (x > left + kSide - 140) {
      x = left;
      y += 22;
    }
    canvas.rectangle({x, y - 11}, 14, 14, swatch.colour);
    x = canvas.text({x + 20, y}, swatch.label, {13, snapshot::kInk}) + 18;
  }
}

}  // namespace

const std::vector<Swatch> kMapLegend = {{snapshot::kHardColour, "HARD"},
                                        {snapshot::kSoftColour, "SOFT"},
                                        {snapshot::kNegativeColour, "NEGATIVE"},
                                        {snapshot::kSteepColour, "STEEP"},
                                        {snapshot::kSeenThrough, "no ground found"},
                                        {snapshot::kUnknown, "not observed"}};

PanelWindow::PanelWindow(const Frame& frame, double edge_m) : frame_(frame), edge_m_(edge_m) {
  for (int axis = 0; axis < 2; ++axis)
    first_[axis] = static_cast<std::int64_t>(std::floor(frame.base_m[axis] / edge_m)) - kShownColumns / 2;
}

std::int64_t PanelWindow::in_frame(int x, int y) const {
  const std::int64_t at_x = first_[0] + x - frame_.origin[0], at_y = first_[1] + y - frame_.origin[1];
  const bool outside = at_x < 0 || at_y < 0 || at_x >= frame_.size || at_y >= frame_.size;
  return outside ? -1 : at_y * frame_.size + at_x;
}

Point PanelWindow::pixel(const Eigen::Vector2d& point_m, int left) const {
  const double x = point_m.x() / edge_m_ - static_cast<double>(first_[0]);
  const double y = point_m.y() / edge_m_ - static_cast<double>(first_[1]);
  return {left + x * kColumnPixels, kPanelTop + (kShownColumns - y) * kColumnPixels};
}

Canvas make_canvas(int panels, const std::string& title) {
  Canvas canvas(kPanelMargin + panels * (kSide + kPanelMargin), kPanelTop + kSide + kLegend,
                snapshot::kPaper);
  canvas.text({kPanelMargin, 34}, title, {22, snapshot::kInk, true});
  return canvas;
}

void draw_panel(Canvas& canvas, int number, const PanelText& text, const PanelWindow& window,
                const std::vector<Rgb>& colours) {
  const int left = kPanelMargin + number * (kSide + kPanelMargin);
  canvas.text({static_cast<double>(left), kPanelTop - 14}, text.name, {16, snapshot::kInk, true});
  canvas.blocks(left, kPanelTop, kColumnPixels, kShownColumns, colours);
  canvas.outline({static_cast<double>(left), kPanelTop}, kSide, kSide, snapshot::kFaintInk);
  draw_vehicle(canvas, left, window);
  draw_legend(canvas, left, text.legend);
}

Rgb shade(Rgb colour, double light) {
  const auto part = [light](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value * light, 0.0, 255.0)));
  };
  return {part(colour.r), part(colour.g), part(colour.b)};
}

Rgb map_colour(const PanelWindow& window, int x, int y) {
  const Frame& frame = window.frame();
  const std::int64_t at = window.in_frame(x, y);
  if (at < 0 || !is_observed(frame.visibility[at])) return snapshot::kUnknown;
  const std::uint8_t flags = frame.flags[at];
  if (flags & kHard) return snapshot::kHardColour;
  if (flags & kNegative) return snapshot::kNegativeColour;
  if (flags & kSteep) return snapshot::kSteepColour;
  if (flags & kSoft) return snapshot::kSoftColour;
  if (std::isnan(frame.height[at])) return snapshot::kSeenThrough;
  if (at < frame.size || at % frame.size == 0) return snapshot::kPlainGround;
  const double slope_x = (frame.height[at] - frame.height[at - 1]) / window.edge_m();
  return std::isnan(slope_x) ? snapshot::kPlainGround
                             : shade(snapshot::kPlainGround, std::clamp(1.0 + 0.6 * slope_x, 0.5, 1.25));
}

}  // namespace gvom::evaluation
