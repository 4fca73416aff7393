#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "tools/snapshot/draw.hpp"

namespace gvom::snapshot {
namespace {

constexpr double kReach_m = 15;  // to each side of base_link
constexpr double kHalfHeight_m = 5;
constexpr double kBeside_m = 1;  // so far beside the view's plane heights are shown
constexpr double kPixels_per_m = 18;
constexpr int kGap = 24, kTitle = 44;
constexpr int kViewWidth = static_cast<int>(2 * kReach_m * kPixels_per_m);
constexpr int kViewHeight = static_cast<int>(2 * kHalfHeight_m * kPixels_per_m);
constexpr int kRow = kViewHeight + kTitle + kGap;
constexpr Rgb kExpected{40, 110, 220};
constexpr Rgb kWell{20, 140, 60};

/// A section through the vehicle: x ahead or y to the left, and z, of base_link.
struct View {
  std::size_t axis;  // 0: x, 1: y
  Point corner;

  [[nodiscard]] bool holds(double along_m, double z_m) const {
    return std::abs(along_m) <= kReach_m && std::abs(z_m) <= kHalfHeight_m;
  }
  [[nodiscard]] Point at(double along_m, double z_m) const {
    const double right_m = axis == 0 ? along_m : -along_m;  // seen from behind, left is left
    return {corner.x + (right_m + kReach_m) * kPixels_per_m,
            corner.y + (kHalfHeight_m - z_m) * kPixels_per_m};
  }
};

/// The part of z = at_m + slope * along that is in the view.
void draw_plane(Canvas& canvas, const View& view, double at_m, double slope, double thickness, Rgb colour) {
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    const double from_m = kReach_m * (2.0 * i / kSteps - 1), to_m = from_m + 2 * kReach_m / kSteps;
    const double from_z_m = at_m + slope * from_m, to_z_m = at_m + slope * to_m;
    if (view.holds(from_m, from_z_m) && view.holds(from_m, to_z_m))
      canvas.line(view.at(from_m, from_z_m), view.at(to_m, to_z_m), thickness, colour);
  }
}

using Vector = std::array<double, 3>;

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A direction of odom in base_link.
Vector in_base(const std::array<double, 4>& orientation_xyzw, const Vector& v) {
  const Vector u{-orientation_xyzw[0], -orientation_xyzw[1], -orientation_xyzw[2]};
  const Vector once = cross(u, v), twice = cross(u, once);
  Vector turned{};
  for (std::size_t i = 0; i < 3; ++i) turned[i] = v[i] + 2 * (orientation_xyzw[3] * once[i] + twice[i]);
  return turned;
}

/// The layers' heights near the view's plane, in base_link.
void draw_heights(Canvas& canvas, const View& view, const LayersPicture& picture) {
  const auto& t = picture.base_position_m;
  if (std::isnan(picture.base_orientation_xyzw[0]) || std::isnan(t[0])) return;
  const float* height = picture.floats(LayerId::height);
  for (int y = 0; y < picture.n_xy; ++y)
    for (int x = 0; x < picture.n_xy; ++x) {
      const double z_m = height[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.n_xy) +
                                static_cast<std::size_t>(x)];
      if (std::isnan(z_m)) continue;
      const Vector from_base{(picture.origin_voxels[0] + x + 0.5) * picture.resolution_xy_m - t[0],
                             (picture.origin_voxels[1] + y + 0.5) * picture.resolution_xy_m - t[1],
                             z_m - t[2]};
      const Vector p = in_base(picture.base_orientation_xyzw, from_base);
      if (std::abs(p[1 - view.axis]) > kBeside_m || !view.holds(p[view.axis], p[2])) continue;
      const Point at = view.at(p[view.axis], p[2]);
      canvas.rectangle({at.x - 1.5, at.y - 1.5}, 3, 3, kFaintInk);
    }
}

void draw_view(Canvas& canvas, const View& view, const LayersPicture& picture, const ipc::Ground& ground) {
  canvas.outline(view.corner, kViewWidth, kViewHeight, kFaintInk);
  const char* const left = view.axis == 0 ? "behind" : "left";
  const char* const right = view.axis == 0 ? "ahead" : "right";
  const TextStyle faint{12, kFaintInk, false};
  canvas.text({view.corner.x + 6, view.corner.y + 16}, left, faint);
  canvas.text({view.corner.x + kViewWidth - canvas.text_width(right, faint) - 6, view.corner.y + 16}, right,
              faint);
  draw_heights(canvas, view, picture);
  if (ground.verdict != static_cast<std::uint32_t>(ipc::GroundVerdict::none))
    draw_plane(canvas, view, ground.expected_z_m, 0, 2, kExpected);
  if (ground.sweeps > 0) {
    const bool wrong = ground.verdict == static_cast<std::uint32_t>(ipc::GroundVerdict::wrong);
    const double slope = view.axis == 0 ? ground.slope_x : ground.slope_y;
    draw_plane(canvas, view, double{ground.expected_z_m} + ground.height_m, slope, 3, wrong ? kAlarm : kWell);
  }
  const Point base = view.at(0, 0);
  canvas.polygon({{base.x - 9, base.y + 6}, {base.x + 9, base.y + 6}, {base.x, base.y - 9}}, kPaper, kInk);
}

std::string words_of(const LidarLine& lidar) {
  const ipc::Ground& ground = lidar.ground;
  const char* const verdict =
      ground.verdict == static_cast<std::uint32_t>(ipc::GroundVerdict::wrong)  ? "WRONG"
      : ground.verdict == static_cast<std::uint32_t>(ipc::GroundVerdict::well) ? "well"
                                                                               : "not judged";
  if (ground.verdict == static_cast<std::uint32_t>(ipc::GroundVerdict::none))
    return lidar.name + ": the ground is not known here";
  if (ground.sweeps == 0) return lidar.name + ": the ground is not judged: too little of it is seen";
  char text[160];
  std::snprintf(text, sizeof text,
                ": %s. Ground %.2f m %s where the vehicle's file puts it, tilted by %.1f degrees", verdict,
                std::abs(double{ground.height_m}), ground.height_m < 0 ? "below" : "above",
                std::atan(std::hypot(double{ground.slope_x}, double{ground.slope_y})) * 180 / M_PI);
  return lidar.name + text;
}

}  // namespace

Canvas render_ground(const LayersPicture& picture) {
  const int rows = std::max<int>(1, static_cast<int>(picture.lidars.size()));
  Canvas canvas(2 * kViewWidth + 3 * kGap, kHeaderHeight + rows * kRow + kGap, kPaper);
  draw_header(canvas, kGap, picture);
  double top = kHeaderHeight;
  for (const LidarLine& lidar : picture.lidars) {
    const bool wrong = lidar.ground.verdict == static_cast<std::uint32_t>(ipc::GroundVerdict::wrong);
    canvas.text({kGap, top + 18}, words_of(lidar), {16, wrong ? kAlarm : kInk, true});
    const TextStyle faint{12, kFaintInk, false};
    canvas.text(
        {kGap, top + 36},
        "blue: where it should be; green or red: where this lidar sees it; dots: heights of the layers; "
        "triangle: base_link; 30 m by 10 m",
        faint);
    draw_view(canvas, {0, {kGap, top + kTitle}}, picture, lidar.ground);
    draw_view(canvas, {1, {2.0 * kGap + kViewWidth, top + kTitle}}, picture, lidar.ground);
    top += kRow;
  }
  return canvas;
}

}  // namespace gvom::snapshot
