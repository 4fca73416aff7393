#include "tools/drive/pictures/plot.hpp"

#include <algorithm>
#include <cmath>

#include "tools/snapshot/draw.hpp"

namespace gvom::driving {
namespace {

using snapshot::Canvas;
using snapshot::Point;

constexpr double kDash_px = 7;

}  // namespace

void draw_polyline(Canvas& canvas, const std::vector<Point>& points, double thickness, snapshot::Rgb colour,
                   bool dashed) {
  double along_px = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Point from = points[i - 1], to = points[i];
    const double length_px = std::hypot(to.x - from.x, to.y - from.y);
    for (double at = 0; at < length_px;) {
      const double left_px = dashed ? kDash_px - std::fmod(along_px, kDash_px) : length_px;
      const double end = std::min(length_px, at + std::max(left_px, 1e-3));
      const auto place = [&](double s) {
        return Point{from.x + (to.x - from.x) * s / length_px, from.y + (to.y - from.y) * s / length_px};
      };
      const bool gap = dashed && static_cast<int>(along_px / kDash_px) % 2 == 1;
      if (!gap) canvas.line(place(at), place(end), thickness, colour);
      along_px += end - at;
      at = end;
    }
  }
}

void draw_plot(Canvas& canvas, const PlotArea& area, const Axes& axes, const std::vector<Curve>& curves) {
  double longest = 0, highest = 0;
  for (const Curve& curve : curves) {
    longest = std::max(longest, curve.step * static_cast<double>(curve.values.size()));
    for (const double value : curve.values) highest = std::max(highest, value);
  }
  const snapshot::Scale across{0, std::max(longest, 1e-9)},
      up{axes.logarithmic ? 1.0 : 0.0, std::max(1.05 * highest, axes.logarithmic ? 2.0 : 1e-9),
         axes.logarithmic};
  const double bottom = area.top + area.height;
  canvas.text({area.left, area.top - 9}, axes.title, {14, snapshot::kInk, true});
  for (const snapshot::Tick& tick : snapshot::ticks(up, 5)) {
    const double y = bottom - area.height * up.fraction(tick.value);
    canvas.line({area.left, y}, {area.left + area.width, y}, 1, {228, 230, 234});
    const double width = canvas.text_width(tick.label, {12, snapshot::kInk});
    canvas.text({area.left - 8 - width, y + 4}, tick.label, {12, snapshot::kInk});
  }
  for (const snapshot::Tick& tick : snapshot::ticks(across, 10)) {
    const double x = area.left + area.width * across.fraction(tick.value);
    canvas.line({x, bottom}, {x, bottom + 5}, 1, snapshot::kFaintInk);
    const double width = canvas.text_width(tick.label, {12, snapshot::kInk});
    canvas.text({x - 0.5 * width, bottom + 19}, tick.label, {12, snapshot::kInk});
  }
  canvas.text({area.left + area.width - canvas.text_width(axes.x_label, {12, snapshot::kInk}), bottom + 36},
              axes.x_label, {12, snapshot::kFaintInk});
  double label_x = area.left + area.width;
  for (const Curve& curve : curves) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < curve.values.size(); ++i)
      points.push_back({area.left + area.width * across.fraction(curve.step * static_cast<double>(i)),
                        bottom - area.height * up.fraction(curve.values[i])});
    draw_polyline(canvas, points, 2, curve.colour, curve.dashed);
    label_x -= canvas.text_width(curve.label, {12, snapshot::kInk});
    canvas.text({label_x, area.top - 9}, curve.label, {12, snapshot::kInk});
    draw_polyline(canvas, {{label_x - 38, area.top - 13}, {label_x - 8, area.top - 13}}, 3, curve.colour,
                  curve.dashed);
    label_x -= 60;
  }
  canvas.outline({area.left, area.top}, area.width, area.height, snapshot::kFaintInk);
}

}  // namespace gvom::driving
