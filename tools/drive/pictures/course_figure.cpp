#include "tools/drive/pictures/course_figure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "tools/drive/pictures/plot.hpp"
#include "tools/snapshot/draw.hpp"
#include "tools/snapshot/panel.hpp"

namespace gvom::driving {
namespace {

using snapshot::Canvas;
using snapshot::Point;
using snapshot::Rgb;

constexpr int kWidth_px = 1500, kLeastWidth_px = 1000, kEdge_px = 60;
constexpr double kAround_m = 14;  // of the ways, that the map shows
constexpr double kPlot_px = 190;
constexpr Rgb kDriven{236, 110, 10}, kStraight{30, 90, 210}, kObstacle{30, 30, 36};
constexpr double kRough_m2 = 0.01, kSteep_rad = 0.6;  // full colour

/// A rectangle of odom on the canvas, +x right, +y up.
struct MapPlace {
  double left, top, px_per_m;
  Eigen::Vector2d low_m, high_m;

  [[nodiscard]] int width() const { return static_cast<int>((high_m.x() - low_m.x()) * px_per_m); }
  [[nodiscard]] int height() const { return static_cast<int>((high_m.y() - low_m.y()) * px_per_m); }
  [[nodiscard]] Point at(const Eigen::Vector2d& place_m) const {
    return {left + (place_m.x() - low_m.x()) * px_per_m,
            top + height() - (place_m.y() - low_m.y()) * px_per_m};
  }
};

MapPlace place_around(const CourseFigures& figures, double left, double top, double most_width_px,
                      double most_px_per_m) {
  MapPlace place{left, top, 1, figures.straight_m.front(), figures.straight_m.front()};
  for (const auto* way : {&figures.driven_m, &figures.straight_m})
    for (const Eigen::Vector2d& at : *way) {
      place.low_m = place.low_m.cwiseMin(at);
      place.high_m = place.high_m.cwiseMax(at);
    }
  place.low_m.array() -= kAround_m;
  place.high_m.array() += kAround_m;
  place.px_per_m = std::min(most_px_per_m, most_width_px / (place.high_m.x() - place.low_m.x()));
  return place;
}

void draw_words(Canvas& canvas, const PictureWords& words) {
  canvas.text({kEdge_px, 28}, words.title, {16, snapshot::kInk, true});
  canvas.text({kEdge_px, 48}, words.subtitle, {12, snapshot::kFaintInk});
}

/// Obstacles are black, the colours are of `values`, `full` is the last of them.
void draw_map(Canvas& canvas, const MapPlace& place, const JudgedMap& judged, const float* values,
              double full) {
  std::vector<Rgb> pixels;
  const planner::Cells cells = judged.map.cells();
  const auto colour_of = [&](int cell) {
    if (judged.costs.lethal()[cell] != 0) return kObstacle;
    return std::isfinite(values[cell]) ? snapshot::kHeat.at(values[cell] / full) : snapshot::kPlainGround;
  };
  for (int y = 0; y < place.height(); ++y)
    for (int x = 0; x < place.width(); ++x) {
      const int cell = cells.index_of(place.low_m.x() + (x + 0.5) / place.px_per_m,
                                      place.low_m.y() + (y + 0.5) / place.px_per_m);
      pixels.push_back(cell < 0 || judged.map.visibility[cell] == 0 ? snapshot::kUnknown : colour_of(cell));
    }
  canvas.blocks(static_cast<int>(place.left), static_cast<int>(place.top), 1, place.width(), pixels);
  canvas.outline({place.left, place.top}, place.width(), place.height(), snapshot::kFaintInk);
}

void draw_way(Canvas& canvas, const MapPlace& place, const std::vector<Eigen::Vector2d>& way_m, Rgb colour,
              bool dashed) {
  std::vector<Point> points;
  for (const Eigen::Vector2d& at : way_m) points.push_back(place.at(at));
  draw_polyline(canvas, points, 3, colour, dashed);
}

/// Colours from 0 to `full`, what is black, what is grey, a scale bar; in a line.
void draw_legend(Canvas& canvas, const MapPlace& place, const snapshot::ColourMap& colours,
                 const std::string& none, const std::string& full) {
  constexpr int kBar_px = 160;
  const double y = place.top + place.height() + 10;
  double x = canvas.text({place.left, y + 12}, none, {12, snapshot::kInk}) + 8;
  for (int i = 0; i < kBar_px; ++i) canvas.rectangle({x + i, y}, 1, 14, colours.at((i + 0.5) / kBar_px));
  x = canvas.text({x + kBar_px + 8, y + 12}, full, {12, snapshot::kInk}) + 24;
  for (const auto& [colour, label] :
       {std::pair(kObstacle, "obstacle"), std::pair(snapshot::kUnknown, "not seen")}) {
    canvas.rectangle({x, y}, 14, 14, colour);
    canvas.outline({x, y}, 14, 14, snapshot::kFaintInk);
    x = canvas.text({x + 20, y + 12}, label, {12, snapshot::kInk}) + 24;
  }
  const double bar_m = 10, end = x + bar_m * place.px_per_m;
  canvas.line({x, y + 7}, {end, y + 7}, 3, snapshot::kInk);
  canvas.text({end + 8, y + 12}, "10 m", {12, snapshot::kInk});
}

struct Name {
  const char *key, *words;
};
constexpr Name kNames[] = {{"length_m", "length, m"},
                           {"least_distance_m", "nearest to an obstacle of the map, m"},
                           {"mean_distance_m", "mean distance to the nearest, m"},
                           {"mean_cost", "mean cost of a metre"}};

std::array<double, 4> values_of(const WayFigures& way) {
  return {way.length_m(), way.least_distance_m(), way.mean_distance_m(), way.mean_cost()};
}

}  // namespace

JudgedMap::JudgedMap(const planner::MapView& of, const planner::PlannerConfig& config)
    : map(of), costs(config.costmap, config.vehicle, of.grid.size[0]) {
  costs.update(map);
}

CourseFigures compare_ways(const JudgedMap& judged, std::vector<Eigen::Vector2d> driven_m,
                           std::vector<Eigen::Vector2d> straight_m) {
  CourseFigures figures{std::move(driven_m), std::move(straight_m), {}, {}};
  figures.driven = measure_way(judged.costs, figures.driven_m);
  figures.straight = measure_way(judged.costs, figures.straight_m);
  return figures;
}

Canvas draw_course(const PictureWords& words, const JudgedMap& judged, const CourseFigures& figures) {
  constexpr double kHeader_px = 66, kBetween_px = 70;
  const MapPlace place = place_around(figures, kEdge_px, kHeader_px, kWidth_px - 2 * kEdge_px, 12);
  const double plots_top = kHeader_px + place.height() + kBetween_px;
  const int width_px = std::max(kLeastWidth_px, place.width() + 2 * kEdge_px);
  Canvas canvas(width_px, static_cast<int>(plots_top + 2 * (kPlot_px + kBetween_px)), snapshot::kPaper);
  draw_words(canvas, {words.title + ": roughness of the map of the whole drive", words.subtitle});
  draw_map(canvas, place, judged, judged.map.roughness, kRough_m2);
  draw_way(canvas, place, figures.straight_m, kStraight, true);
  draw_way(canvas, place, figures.driven_m, kDriven, false);
  draw_legend(canvas, place, snapshot::kHeat, "smooth", "0.01 m\u00b2");
  const auto curves = [&](const std::vector<double>& driven, const std::vector<double>& straight) {
    return std::vector<Curve>{{"through the waypoints", kStraight, true, WayFigures::kStep_m, straight},
                              {"driven", kDriven, false, WayFigures::kStep_m, driven}};
  };
  const double width = width_px - 2 * kEdge_px;
  draw_plot(canvas, {kEdge_px, plots_top, width, kPlot_px},
            {"distance to the nearest obstacle, m (10 at most)", "m along the way"},
            curves(figures.driven.distance_m, figures.straight.distance_m));
  draw_plot(canvas, {kEdge_px, plots_top + kPlot_px + kBetween_px, width, kPlot_px},
            {"cost of a metre (good ground 1, on an obstacle 100)", "m along the way", true},
            curves(figures.driven.cost, figures.straight.cost));
  return canvas;
}

Canvas draw_slopes(const PictureWords& words, const JudgedMap& at_start, const JudgedMap& at_end,
                   const CourseFigures& figures) {
  constexpr double kHeader_px = 80, kGap_px = 30;
  const double half_px = (kWidth_px - 2 * kEdge_px - kGap_px) / 2;
  const MapPlace first = place_around(figures, kEdge_px, kHeader_px, half_px, 12);
  MapPlace second = first;
  second.left += first.width() + kGap_px;
  Canvas canvas(static_cast<int>(second.left) + second.width() + kEdge_px,
                static_cast<int>(kHeader_px) + first.height() + 50, snapshot::kPaper);
  draw_words(canvas, {words.title + ": slope", words.subtitle});
  canvas.text({first.left, kHeader_px - 9}, "as known after the first second", {14, snapshot::kInk, true});
  canvas.text({second.left, kHeader_px - 9}, "at the end, with the driven way", {14, snapshot::kInk, true});
  draw_map(canvas, first, at_start, at_start.map.slope, kSteep_rad);
  draw_map(canvas, second, at_end, at_end.map.slope, kSteep_rad);
  draw_way(canvas, first, figures.straight_m, kStraight, true);
  draw_way(canvas, second, figures.straight_m, kStraight, true);
  draw_way(canvas, second, figures.driven_m, kDriven, false);
  draw_legend(canvas, first, snapshot::kHeat, "level", "34\u00b0");
  return canvas;
}

std::string text_of(const CourseFigures& figures) {
  const auto driven = values_of(figures.driven), straight = values_of(figures.straight);
  std::string text = std::string(40, ' ') + "driven  through the waypoints\n";
  for (std::size_t i = 0; i < driven.size(); ++i) {
    char line[96];
    std::snprintf(line, sizeof line, "%-37s %8.2f %8.2f\n", kNames[i].words, driven[i], straight[i]);
    text += line;
  }
  return text;
}

std::string json_of(const CourseFigures& figures) {
  std::string text;
  for (const auto& [name, way] :
       {std::pair("driven", &figures.driven), std::pair("waypoints", &figures.straight)}) {
    const auto values = values_of(*way);
    text += std::string(text.empty() ? "" : ", ") + "\"" + name + "\": {";
    for (std::size_t i = 0; i < values.size(); ++i) {
      char item[64];
      std::snprintf(item, sizeof item, "%s\"%s\": %.3f", i > 0 ? ", " : "", kNames[i].key, values[i]);
      text += item;
    }
    text += "}";
  }
  return text;
}

}  // namespace gvom::driving
