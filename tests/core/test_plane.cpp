// The arithmetic that both back ends share (R12), against other ways to the same numbers.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/plane.hpp"
#include "tests/core/random.hpp"

namespace gvom::test {
namespace {

using Long3 = Eigen::Matrix<long double, 3, 1>;

struct Patch {
  int reach;
  std::vector<float> z_m;  // [dy][dx]; NaN is undefined

  template <class Visit>
  void each(Visit&& visit) const {
    std::size_t i = 0;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) visit(dx, dy, z_m[i++]);
  }
};

Plane fit(const Patch& patch, double resolution_m, double threshold_rad = 0.5) {
  PlaneSums sums{};
  patch.each([&](int dx, int dy, float z_m) { add_height(sums, dx, dy, z_m); });
  const PlaneFit plane = solve_plane(sums);
  double squares_m2 = 0;
  patch.each([&](int dx, int dy, float z_m) { squares_m2 += squared_residual(plane, dx, dy, z_m); });
  return plane_layers(plane, sums, squares_m2, resolution_m, threshold_rad, [] { return false; });
}

// Slopes in x and y and the mean squared residual, by a decomposition in long double.
Long3 fit_by_qr(const Patch& patch, long double resolution_m) {
  Eigen::Matrix<long double, Eigen::Dynamic, 3> A(patch.z_m.size(), 3);
  Eigen::Matrix<long double, Eigen::Dynamic, 1> z(patch.z_m.size());
  Eigen::Index n = 0;
  patch.each([&](int dx, int dy, float z_m) {
    if (std::isnan(z_m)) return;
    A.row(n) << dx * resolution_m, dy * resolution_m, 1;
    z(n++) = z_m;
  });
  const auto points = A.topRows(n);
  const Long3 plane = points.colPivHouseholderQr().solve(z.head(n));
  return {plane[0], plane[1], (points * plane - z.head(n)).squaredNorm() / n};
}

float heights(std::initializer_list<float> z_m, float Plane::*value) {
  return fit({1, z_m}, 0.5).*value;
}

TEST_CASE("The arctangent is the library's") {
  for (int i = 0; i <= 100'000; ++i) {
    const double x = i * 1e-4;
    REQUIRE(std::abs(arctangent(x) - std::atan(x)) < 4e-16);
  }
  for (const double x : {1e-300, 1e-12, 0.0625, 0.9375, 1.0, 1.0000001, 1e3, 1e12, 1e300}) {
    CAPTURE(x);
    CHECK(arctangent(x) == Approx(std::atan(x)).epsilon(1e-15));
  }
  CHECK(arctangent(0) == 0);
  CHECK(arctangent(INFINITY) == Approx(std::acos(0.0)));
}

TEST_CASE("Planes are the least-squares solver's, with heights missing and far from zero") {
  Random random(11);
  for (int i = 0; i < 3000; ++i) {
    Patch patch{random.integer(1, 7), {}};
    const double defined = random.uniform(0.3, 1), base_m = random.pick({0.0, 5.0, -900.0}),
                 noise_m = random.pick({0.0, 0.1, 3.0});
    const double a = random.uniform(-1, 1), b = random.uniform(-1, 1),
                 resolution_m = random.pick({0.1, 0.4, 2.0});
    int n = 0;
    patch.z_m.resize(std::size_t((2 * patch.reach + 1) * (2 * patch.reach + 1)), NAN);
    std::size_t k = 0;
    patch.each([&](int dx, int dy, float) {
      const double z_m =
          base_m + a * dx * resolution_m + b * dy * resolution_m + random.uniform(-noise_m, noise_m);
      if (random.chance(defined)) patch.z_m[k] = static_cast<float>(z_m), ++n;
      ++k;
    });
    const Plane plane = fit(patch, resolution_m);
    if (std::isnan(plane.slope_x)) {
      REQUIRE(n < 6);  // more than five of nine can't be on one line
      continue;
    }
    const Long3 due = fit_by_qr(patch, resolution_m);
    INFO("patch " << i);
    REQUIRE(plane.slope_x == Approx(static_cast<double>(due[0])).epsilon(1e-6).margin(1e-6));
    REQUIRE(plane.slope_y == Approx(static_cast<double>(due[1])).epsilon(1e-6).margin(1e-6));
    REQUIRE(plane.roughness == Approx(static_cast<double>(due[2])).epsilon(1e-6).margin(1e-9));
    const double steepness = std::hypot(static_cast<double>(due[0]), static_cast<double>(due[1]));
    REQUIRE(plane.slope == Approx(std::atan(steepness)).epsilon(1e-6).margin(1e-6));
  }
}

TEST_CASE("Fewer than five heights, or heights on one line, make no plane") {
  constexpr float n = NAN;
  CHECK(std::isnan(heights({n, n, n, n, n, n, n, n, n}, &Plane::slope)));
  CHECK(std::isnan(heights({1, 1, 1, 1, n, n, n, n, n}, &Plane::slope)));
  CHECK(std::isnan(heights({1, n, 1, n, n, n, 1, n, 1}, &Plane::roughness)));  // four corners
  CHECK(heights({1, n, 1, n, 1, n, 1, n, 1}, &Plane::slope) == 0);
  const Patch row{2, {n, n, n, n, n, n, n, n, n, n, 1, 1, 1, 1, 1, n, n, n, n, n, n, n, n, n, n}};
  CHECK(std::isnan(fit(row, 0.5).slope_x));
}

TEST_CASE("A raised middle of h is rough by 8 h^2 / 81") {
  CHECK(heights({0, 0, 0, 0, 0.25, 0, 0, 0, 0}, &Plane::roughness) == Approx(8 * 0.0625 / 81));
  CHECK(heights({0, 0, 0, 0, 0.25, 0, 0, 0, 0}, &Plane::slope) == 0);
}

TEST_CASE("Slopes are metres per metre, x along rows and y across") {
  CHECK(heights({0, 1, 2, 0, 1, 2, 0, 1, 2}, &Plane::slope_x) == 2);
  CHECK(heights({0, 1, 2, 0, 1, 2, 0, 1, 2}, &Plane::slope_y) == 0);
  CHECK(heights({2, 2, 2, 1, 1, 1, 0, 0, 0}, &Plane::slope_y) == -2);
  CHECK(heights({2, 2, 2, 1, 1, 1, 0, 0, 0}, &Plane::slope) == Approx(std::atan(2.0)));
}

TEST_CASE("A plane is steep from the threshold on") {
  const Patch one_to_one{1, {0, 1, 2, 0, 1, 2, 0, 1, 2}};
  CHECK(fit(one_to_one, 1.0, arctangent(1)).steep);
  CHECK_FALSE(fit(one_to_one, 1.0, std::nextafter(arctangent(1), 2)).steep);
}

TEST_CASE("A plane is steep if its slope is, less its standard error") {
  // 0.6 m/m and residuals of 0.2, -0.4 and 0.2 m: 0.08 m^2 over six columns^2, an error of 0.1155 m/m.
  const Patch step{1, {0, 0, 1.2f, 0, 0, 1.2f, 0, 0, 1.2f}};
  CHECK(fit(step, 1.0).slope_x == Approx(0.6));
  CHECK(fit(step, 1.0).roughness == Approx(0.08));
  const double surely = 0.6 - std::sqrt(0.08 / 6);
  CHECK(fit(step, 1.0, std::atan(surely) - 1e-6).steep);
  CHECK_FALSE(fit(step, 1.0, std::atan(surely) + 1e-6).steep);
}

TEST_CASE("A slope that is all error is never steep") {
  CHECK_FALSE(fit({1, {0, 9, 0, 0, 0, 9, 9, 0, 0.5f}}, 1.0, 0.0).steep);
  CHECK_FALSE(fit({1, {0, 0, 0, 0, 0, 0, 0, 0, 0}}, 1.0, 0.0).steep);
}

}  // namespace
}  // namespace gvom::test
