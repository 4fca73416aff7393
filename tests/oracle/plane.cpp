#include "tests/oracle/plane.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace gvom::oracle {

namespace {

// Whole numbers: exact.
struct Whole {
  std::int64_t n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

  explicit Whole(const std::vector<HeightAt>& heights) {
    for (const HeightAt& h : heights) {
      n += 1;
      x += h.dx;
      y += h.dy;
      xx += h.dx * h.dx;
      xy += h.dx * h.dy;
      yy += h.dy * h.dy;
    }
  }
};

template <class Term>
double sum(const std::vector<HeightAt>& heights, Term&& term) {
  double total = 0;
  for (const HeightAt& h : heights) total += term(h);
  return total;
}

double angle_of(double x) {
  if (x > 1) return std::acos(0.0) - angle_of(1 / x);
  const double eighths = std::floor(8 * x + 0.5);
  const double c = eighths / 8;
  const double t = (x - c) / (1 + x * c), square = t * t;
  double series = 0;
  for (const double odd : {13.0, 11.0, 9.0, 7.0, 5.0, 3.0, 1.0}) series = 1 / odd - square * series;
  return static_cast<double>(std::atan(static_cast<long double>(c))) + t * series;
}

}  // namespace

PlaneValues plane_through(const std::vector<HeightAt>& heights, double resolution_m, double threshold_rad) {
  const Whole w(heights);
  const std::int64_t xx = w.n * w.xx - w.x * w.x, xy = w.n * w.xy - w.x * w.y, yy = w.n * w.yy - w.y * w.y;
  const std::int64_t determinant = xx * yy - xy * xy;
  if (w.n < 5 || determinant <= 0) return {NAN, NAN, NAN, NAN, false};

  const auto exact = [](std::int64_t whole) { return static_cast<double>(whole); };
  const double z = sum(heights, [](const HeightAt& h) { return h.z_m; });
  const double xz =
      exact(w.n) * sum(heights, [](const HeightAt& h) { return h.dx * h.z_m; }) - exact(w.x) * z;
  const double yz =
      exact(w.n) * sum(heights, [](const HeightAt& h) { return h.dy * h.z_m; }) - exact(w.y) * z;
  const double a = (exact(yy) * xz - exact(xy) * yz) / exact(determinant);
  const double b = (exact(xx) * yz - exact(xy) * xz) / exact(determinant);
  const double c = (z - a * exact(w.x) - b * exact(w.y)) / exact(w.n);
  const double squares_m2 = sum(heights, [&](const HeightAt& h) {
    const double plane_m = a * h.dx + b * h.dy + c;
    return (h.z_m - plane_m) * (h.z_m - plane_m);
  });

  const double along_x = a / resolution_m, along_y = b / resolution_m;
  const double steepness = std::sqrt(along_x * along_x + along_y * along_y);
  const double roughness = squares_m2 / exact(w.n);
  const double spread = exact(std::min(xx, yy)) / exact(w.n);
  const auto remembered =
      std::count_if(heights.begin(), heights.end(), [](const HeightAt& h) { return h.remembered; });
  const bool of_two_times = remembered > 0 && remembered < w.n;
  const double surely = steepness - std::sqrt(roughness / spread) / resolution_m - (of_two_times ? 0.25 : 0);
  const double slope = angle_of(steepness);
  return {static_cast<float>(along_x), static_cast<float>(along_y), static_cast<float>(slope),
          static_cast<float>(roughness),
          slope >= threshold_rad && surely > 0 && angle_of(surely) >= threshold_rad};
}

}  // namespace gvom::oracle
