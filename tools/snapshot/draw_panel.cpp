#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/snapshot/draw.hpp"

namespace gvom::snapshot {
namespace {

constexpr int kBarWidth = 18;
constexpr int kLegendGap = 14;
constexpr int kSwatchHeight = 20;
constexpr int kBarGap = 34;

/// An arrow head whose middle is where base_link is; a diamond where the heading is not known.
void draw_vehicle(Canvas& canvas, const MapArea& area, const LayersPicture& picture) {
  const auto& base = picture.base_position_m;
  if (std::isnan(base[0]) || std::isnan(base[1])) return;
  const Point at{
      area.left + area.zoom * (base[0] / picture.resolution_xy_m - picture.origin_voxels[0]),
      area.top + area.zoom * (area.n_xy - (base[1] / picture.resolution_xy_m - picture.origin_voxels[1]))};
  const double size = std::max(10.0, area.size_px() / 52.0);
  const double yaw_rad = picture.base_yaw_rad();
  const bool heading_known = !std::isnan(yaw_rad);
  const double c = heading_known ? std::cos(yaw_rad) : 1.0;
  const double s = heading_known ? std::sin(yaw_rad) : 0.0;
  const auto corner = [&](double forward, double left) {
    return Point{at.x + size * (c * forward - s * left), at.y - size * (s * forward + c * left)};
  };
  const double tail = heading_known ? -0.35 : -1.0;
  const double wing = heading_known ? -0.8 : 0.0;
  const double nose = heading_known ? 1.2 : 1.0;
  canvas.polygon({corner(nose, 0), corner(wing, 0.8), corner(tail, 0), corner(wing, -0.8)}, {255, 255, 255},
                 {0, 0, 0});
}

void draw_bar(Canvas& canvas, const Bar& bar, Point corner, double height) {
  for (int row = 0; row < height; ++row)
    canvas.rectangle({corner.x, corner.y + row}, kBarWidth, 1, bar.map->at(1.0 - (row + 0.5) / height));
  canvas.outline(corner, kBarWidth, height, kFaintInk);
  if (!bar.caption.empty()) canvas.text({corner.x, corner.y - 7}, bar.caption, {12, kInk, true});
  const int wanted = std::clamp(static_cast<int>(height / 50), 2, 8);
  for (const Tick& tick : ticks(bar.scale, wanted)) {
    const double y = corner.y + height * (1.0 - bar.scale.fraction(tick.value));
    canvas.line({corner.x + kBarWidth, y}, {corner.x + kBarWidth + 4, y}, 1, kFaintInk);
    canvas.text({corner.x + kBarWidth + 7, y + 4.5}, tick.label, {12, kInk});
  }
}

/// Bars above, swatches at the bottom.
void draw_legend(Canvas& canvas, const MapArea& area, const Panel& panel) {
  const double left = area.left + area.size_px() + kLegendGap;
  const double bottom = area.top + area.size_px();
  double y = bottom - kSwatchHeight * static_cast<double>(panel.swatches.size());
  const double bars_end = y - 12;
  for (const Swatch& swatch : panel.swatches) {
    canvas.rectangle({left, y + 5}, 14, 14, swatch.colour);
    canvas.outline({left, y + 5}, 14, 14, kFaintInk);
    canvas.text({left + 20, y + 16.5}, swatch.label, {12, kInk});
    y += kSwatchHeight;
  }
  if (panel.bars.empty()) return;
  const auto bars = static_cast<double>(panel.bars.size());
  const double captions = panel.bars.front().caption.empty() ? 6 : 20;
  const double each = (bars_end - area.top - captions - (bars - 1) * kBarGap) / bars;
  if (each < 40) return;
  double top = area.top + captions;
  for (const Bar& bar : panel.bars) {
    draw_bar(canvas, bar, {left, top}, std::floor(each));
    top += each + kBarGap;
  }
}

void draw_scale_bar(Canvas& canvas, const MapArea& area, double resolution_m) {
  const double length_m = round_below(area.n_xy * resolution_m / 4.0);
  const double length_px = length_m / resolution_m * area.zoom;
  const Point start{double(area.left), area.top + area.size_px() + 18.0};
  const Point end{start.x + length_px, start.y};
  canvas.line(start, end, 3, kInk);
  for (const Point& tip : {start, end}) canvas.line({tip.x, tip.y - 6}, {tip.x, tip.y + 6}, 1.5, kInk);
  char label[32];
  std::snprintf(label, sizeof label, "%g m", length_m);
  canvas.text({end.x + 9, end.y + 4.5}, label, {12, kInk});
}

void draw_axes(Canvas& canvas, const MapArea& area) {
  constexpr double kLength = 22;
  const Point corner{area.left + area.size_px() - 82.0, area.top + area.size_px() + 32.0};
  const Point right{corner.x + kLength, corner.y};
  const Point up{corner.x, corner.y - kLength};
  canvas.line(corner, right, 1.5, kInk);
  canvas.line(corner, up, 1.5, kInk);
  canvas.polygon({{right.x + 5, right.y}, {right.x - 2, right.y - 3}, {right.x - 2, right.y + 3}}, kInk,
                 kInk);
  canvas.polygon({{up.x, up.y - 5}, {up.x - 3, up.y + 2}, {up.x + 3, up.y + 2}}, kInk, kInk);
  canvas.text({right.x + 10, right.y + 4}, "x", {12, kInk, true});
  canvas.text({up.x + 8, up.y + 5}, "y", {12, kInk, true});
  canvas.text({right.x + 22, right.y + 4}, "odom", {11, kFaintInk});
}

}  // namespace

void draw_panel(Canvas& canvas, const MapArea& area, const LayersPicture& picture, const Panel& panel) {
  const Point title{double(area.left), area.top - 10.0};
  const double end = canvas.text(title, panel.title, {15, kInk, true});
  if (!panel.unit.empty()) canvas.text({end + 10, title.y}, panel.unit, {12, kFaintInk});
  canvas.blocks(area.left, area.top, area.zoom, area.n_xy, panel.columns);
  canvas.outline({double(area.left), double(area.top)}, area.size_px(), area.size_px(), kFaintInk);
  draw_vehicle(canvas, area, picture);
  draw_legend(canvas, area, panel);
  draw_scale_bar(canvas, area, picture.resolution_xy_m);
  draw_axes(canvas, area);
}

}  // namespace gvom::snapshot
