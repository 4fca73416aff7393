#include "tools/drive/pictures/strip.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/snapshot/draw.hpp"
#include "tools/snapshot/panel.hpp"

namespace gvom::driving {
namespace {

using snapshot::Canvas;
using snapshot::Point;
using snapshot::Rgb;

constexpr int kGap_px = kFirstLeft_px, kCaption_px = 44, kLegend_px = 40;
constexpr double kWhySize_px = 12;
constexpr Rgb kWay{30, 30, 36}, kPath{24, 96, 210}, kTrajectory{240, 120, 10}, kWaypoint{10, 130, 60},
    kObstacle{0, 0, 0};
constexpr Rgb kGround{238, 226, 196};
constexpr double kFaded = 0.6;  // remembered, towards white

Rgb mixed(Rgb colour, Rgb with, double share) {
  const auto mix = [share](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + share * (b - a)));
  };
  return {mix(colour.r, with.r), mix(colour.g, with.g), mix(colour.b, with.b)};
}

/// Light from the upper left.
double light_of(float slope_x, float slope_y) {
  if (!std::isfinite(slope_x) || !std::isfinite(slope_y)) return 1;
  return std::clamp(1 + 0.9 * (slope_x - slope_y), 0.55, 1.1);
}

Rgb colour_of(const Frame& frame, std::size_t i) {
  const std::uint8_t flags = frame.flags[i];
  Rgb colour = snapshot::kUnknown;
  if (flags & kHard) {
    colour = snapshot::kHardColour;
  } else if (flags & kNegative) {
    colour = snapshot::kNegativeColour;
  } else if (flags & kSoft) {
    colour = snapshot::kSoftColour;
  } else if (flags & kSteep) {
    colour = snapshot::kSteepColour;
  } else if (std::isfinite(frame.height[i])) {
    colour = mixed({0, 0, 0}, kGround, std::min(1.0, light_of(frame.slope_x[i], frame.slope_y[i])));
  } else {
    return colour;
  }
  return is_remembered(frame.visibility[i]) ? mixed(colour, snapshot::kPaper, kFaded) : colour;
}

/// Of one frame: pixels of places in odom.
struct View {
  int left, top;
  Eigen::Vector2d middle_m;

  [[nodiscard]] Point at(const Eigen::Vector2d& place_m) const {
    const double px_per_m = kFrame_px / kFrame_m;
    return {left + kFrame_px / 2 + (place_m.x() - middle_m.x()) * px_per_m,
            top + kFrame_px / 2 - (place_m.y() - middle_m.y()) * px_per_m};
  }
  [[nodiscard]] bool holds(const Eigen::Vector2d& place_m) const {
    return (place_m - middle_m).cwiseAbs().maxCoeff() < kFrame_m / 2;
  }
};

/// A pixel shows the column that its middle lies in.
void draw_map(Canvas& canvas, const View& view, const Frame& frame) {
  const double cell_m = frame.grid.resolution_m[0], m_per_px = kFrame_m / kFrame_px;
  std::vector<Rgb> pixels(static_cast<std::size_t>(kFrame_px) * kFrame_px, snapshot::kUnknown);
  const auto cell_of = [&](int px, double middle, int axis) {
    const double m = middle + (px + 0.5 - kFrame_px / 2.0) * m_per_px;
    return static_cast<int>(std::floor(m / cell_m)) - frame.grid.origin[axis];
  };
  for (int y = 0; y < kFrame_px; ++y)
    for (int x = 0; x < kFrame_px; ++x) {
      const int cx = cell_of(x, view.middle_m.x(), 0), cy = cell_of(y, view.middle_m.y(), 1);
      if (cx < 0 || cy < 0 || cx >= frame.grid.size[0] || cy >= frame.grid.size[1]) continue;
      pixels[static_cast<std::size_t>(y) * kFrame_px + x] =
          colour_of(frame, static_cast<std::size_t>(cy) * frame.grid.size[0] + cx);
    }
  canvas.blocks(view.left, view.top, 1, kFrame_px, pixels);
}

void draw_line(Canvas& canvas, const View& view, const std::vector<Eigen::Vector2d>& line, std::size_t count,
               double thickness, Rgb colour) {
  for (std::size_t i = 1; i < std::min(count, line.size()); ++i)
    if (view.holds(line[i - 1]) && view.holds(line[i]))
      canvas.line(view.at(line[i - 1]), view.at(line[i]), thickness, colour);
}

void draw_ring(Canvas& canvas, const View& view, const Eigen::Vector2d& place_m) {
  if (!view.holds(place_m)) return;
  constexpr int kCorners = 16;
  constexpr double kRadius_m = 0.9;
  Eigen::Vector2d before = place_m + Eigen::Vector2d(kRadius_m, 0);
  for (int i = 1; i <= kCorners; ++i) {
    const double angle = 2 * M_PI * i / kCorners;
    const Eigen::Vector2d next = place_m + kRadius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    if (view.holds(before) && view.holds(next)) canvas.line(view.at(before), view.at(next), 3, kWaypoint);
    before = next;
  }
}

void draw_vehicle(Canvas& canvas, const View& view, const planner::Pose2& place,
                  const planner::VehicleLimits& vehicle) {
  const Eigen::Vector2d forward = place.forward(), left(-forward.y(), forward.x());
  const auto corner = [&](double ahead_m, double aside_m) {
    return view.at(place.place() + ahead_m * forward + aside_m * left);
  };
  const double half_m = 0.5 * vehicle.width_m;
  canvas.polygon({corner(vehicle.front_m, half_m), corner(vehicle.front_m, -half_m),
                  corner(-vehicle.rear_m, -half_m), corner(-vehicle.rear_m, half_m)},
                 kVehicleColour, {0, 0, 0});
  canvas.line(corner(0, 0), corner(vehicle.front_m, 0), 2, {0, 0, 0});
}

/// At most two lines of the frame's width.
void draw_why(Canvas& canvas, double left, double top, const std::string& why) {
  const snapshot::TextStyle style{kWhySize_px, snapshot::kFaintInk};
  std::string rest = why;
  for (int line = 0; line < 2 && !rest.empty(); ++line) {
    std::size_t end = rest.size();
    while (end > 0 && canvas.text_width(rest.substr(0, end), style) > kFrame_px) {
      const std::size_t space = rest.rfind(' ', end - 1);
      if (space == std::string::npos) break;
      end = space;
    }
    canvas.text({left, top + 15.0 * line}, rest.substr(0, end), style);
    rest = end < rest.size() ? rest.substr(end + 1) : "";
  }
}

void draw_edges(Canvas& canvas, const View& view, const std::vector<Edge>& edges) {
  for (const auto& [from, to] : edges)
    if (view.holds(from) && view.holds(to)) canvas.line(view.at(from), view.at(to), 1, kObstacle);
}

/// On a plate, so that it is read whatever is below.
void draw_time(Canvas& canvas, const View& view, const Frame& frame) {
  const snapshot::TextStyle style{14, snapshot::kInk, true};
  char when[64];
  std::snprintf(when, sizeof when, "%.1f s   %.1f m/s", frame.time_s,
                std::abs(frame.speed_mps) < 0.1 ? 0.0 : frame.speed_mps);  // a stand, but for the noise
  canvas.rectangle({double(view.left), double(view.top)}, canvas.text_width(when, style) + 14, 24,
                   snapshot::kPaper);
  canvas.text({view.left + 6.0, view.top + 17.0}, when, style);
}

void draw_frame(Canvas& canvas, const View& view, const Frame& frame, const Surroundings& around,
                const planner::VehicleLimits& vehicle) {
  draw_map(canvas, view, frame);
  draw_edges(canvas, view, around.obstacles);
  draw_line(canvas, view, around.way, frame.driven, 2.5, kWay);
  draw_line(canvas, view, frame.path, frame.path.size(), 2, kPath);
  draw_line(canvas, view, frame.trajectory, frame.trajectory.size(), 3, kTrajectory);
  for (const Eigen::Vector2d& waypoint : around.waypoints_m) draw_ring(canvas, view, waypoint);
  draw_vehicle(canvas, view, frame.place, vehicle);
  canvas.outline({double(view.left), double(view.top)}, kFrame_px, kFrame_px, snapshot::kFaintInk);
  draw_time(canvas, view, frame);
  draw_why(canvas, view.left, view.top + kFrame_px + 15, frame.why);
}

void draw_legend(Canvas& canvas, double left, double y) {
  const std::pair<Rgb, const char*> entries[] = {
      {snapshot::kHardColour, "hard"},
      {snapshot::kSoftColour, "soft"},
      {snapshot::kNegativeColour, "negative"},
      {snapshot::kSteepColour, "steep"},
      {snapshot::kUnknown, "unknown"},
      {mixed(kGround, snapshot::kPaper, kFaded), "remembered: faint"},
      {kWay, "driven"},
      {kPath, "path"},
      {kTrajectory, "trajectory"},
      {kWaypoint, "waypoint"},
      {snapshot::kPaper, "outline: true obstacle"}};
  for (const auto& [colour, label] : entries) {
    canvas.rectangle({left, y - 11}, 14, 14, colour);
    canvas.outline({left, y - 11}, 14, 14, snapshot::kFaintInk);
    left = canvas.text({left + 20, y}, label, {12, snapshot::kInk}) + 22;
  }
  const double bar_px = 10 * kFrame_px / kFrame_m;
  canvas.line({left, y - 4}, {left + bar_px, y - 4}, 3, snapshot::kInk);
  canvas.text({left + bar_px + 8, y}, "10 m", {12, snapshot::kInk});
}

}  // namespace

Canvas draw_strip(const std::vector<const Frame*>& frames, const Surroundings& around,
                  const planner::VehicleLimits& vehicle, const PictureWords& words) {
  const int rows = std::max<int>(1, (static_cast<int>(frames.size()) + kFramesInRow - 1) / kFramesInRow);
  const int width = kFramesInRow * (kFrame_px + kGap_px) + kGap_px;
  const int row_px = kFrame_px + kCaption_px + kGap_px / 2;
  Canvas canvas(width, kFirstTop_px + rows * row_px + kLegend_px, snapshot::kPaper);
  canvas.text({kGap_px, 28}, words.title, {20, snapshot::kInk, true});
  canvas.text({kGap_px, 50}, words.subtitle, {14, snapshot::kFaintInk});
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const int column = static_cast<int>(i) % kFramesInRow, row = static_cast<int>(i) / kFramesInRow;
    const View view{kGap_px + column * (kFrame_px + kGap_px), kFirstTop_px + row * row_px,
                    frames[i]->place.place()};
    draw_frame(canvas, view, *frames[i], around, vehicle);
    if (i < around.walkers.size()) draw_edges(canvas, view, around.walkers[i]);
  }
  draw_legend(canvas, kGap_px, kFirstTop_px + rows * row_px + 22);
  return canvas;
}

}  // namespace gvom::driving
