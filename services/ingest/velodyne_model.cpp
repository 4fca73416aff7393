#include "services/ingest/velodyne_model.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace gvom::ingest {
namespace {

/// A VLP-16, or a Puck Hi-Res: the same but for its angles.
VelodyneModel make_puck(std::string_view name, std::uint8_t byte,
                        const std::array<double, 16>& vertical_deg) {
  VelodyneModel model{name, byte, 0.002, 110.592, 1, 2, 55.296, {}, {}};
  for (std::size_t i = 0; i < 32; ++i) {
    const auto firing = static_cast<double>(i / 16);
    const auto laser = static_cast<double>(i % 16);
    model.lasers.push_back({vertical_deg[i % 16], 0, firing * model.firing_us + 2.304 * laser});
  }
  return model;
}

VelodyneModel make_vlp32c() {
  constexpr double kVerticalDeg[32] = {-25,    -1,    -1.667, -15.639, -11.31, 0,     -0.667, -8.843,
                                       -7.254, 0.333, -0.333, -6.148,  -5.333, 1.333, 0.667,  -4,
                                       -4.667, 1.667, 1,      -3.667,  -3.333, 3.333, 2.333,  -2.667,
                                       -3,     7,     4.667,  -2.333,  -2,     15,    10.333, -1.333};
  constexpr double kAzimuthDeg[32] = {1.4,  -4.2, 1.4,  -1.4, 1.4,  -1.4, 4.2,  -1.4, 1.4,  -4.2, 1.4,
                                      -1.4, 4.2,  -1.4, 4.2,  -1.4, 1.4,  -4.2, 1.4,  -4.2, 4.2,  -1.4,
                                      1.4,  -1.4, 1.4,  -1.4, 1.4,  -4.2, 4.2,  -1.4, 1.4,  -1.4};
  VelodyneModel model{"VLP-32C", 0x28, 0.004, 55.296, 1, 1, 55.296, {}, {}};
  for (std::size_t i = 0; i < 32; ++i) {
    model.lasers.push_back({kVerticalDeg[i], kAzimuthDeg[i], 2.304 * static_cast<double>(i / 2)});
  }
  return model;
}

VelodyneModel make_hdl32() {
  constexpr double kVerticalDeg[32] = {-30.67, -9.33, -29.33, -8.00, -28.00, -6.67, -26.67, -5.33,
                                       -25.33, -4.00, -24.00, -2.67, -22.67, -1.33, -21.33, 0.00,
                                       -20.00, 1.33,  -18.67, 2.67,  -17.33, 4.00,  -16.00, 5.33,
                                       -14.67, 6.67,  -13.33, 8.00,  -12.00, 9.33,  -10.67, 10.67};
  VelodyneModel model{"HDL-32", 0x21, 0.002, 46.080, 1, 1, 46.080, {}, {}};
  for (std::size_t i = 0; i < 32; ++i) {
    model.lasers.push_back({kVerticalDeg[i], 0, 1.152 * static_cast<double>(i)});
  }
  return model;
}

/// User manual 63-9483: eight lasers fire at once, every 2.665 us, with a pause of as long after the eighth
/// such group; 20 times that is a sequence.
VelodyneModel make_vls128() {
  constexpr double kVerticalDeg[128] = {
      -11.742, -1.99, 3.4,     -5.29, -0.78,   4.61,   -4.08,   1.31,  -6.5,  -1.11,   4.28,  -4.41,  0.1,
      6.48,    -3.2,  2.19,    -3.86, 1.53,    -9.244, -1.77,   2.74,  -5.95, -0.56,   4.83,  -2.98,  2.41,
      -6.28,   -0.89, 3.62,    -5.07, 0.32,    7.58,   -0.34,   5.18,  -3.64, 1.75,    -25.0, -2.43,  2.96,
      -5.73,   0.54,  9.7,     -2.76, 2.63,    -7.65,  -1.55,   3.84,  -4.85, 3.18,    -5.51, -0.12,  5.73,
      -4.3,    1.09,  -16.042, -2.21, 4.06,    -4.63,  0.76,    15.0,  -3.42, 1.97,    -6.85, -1.33,  -5.62,
      -0.23,   5.43,  -3.53,   0.98,  -19.582, -2.32,  3.07,    -4.74, 0.65,  11.75,   -2.65, 1.86,   -7.15,
      -1.44,   3.95,  -2.1,    3.29,  -5.4,    -0.01,  4.5,     -4.19, 1.2,   -13.565, -1.22, 4.17,   -4.52,
      0.87,    6.08,  -3.31,   2.08,  -6.65,   1.42,   -10.346, -1.88, 3.51,  -6.06,   -0.67, 4.72,   -3.97,
      2.3,     -6.39, -1.0,    4.39,  -5.18,   0.21,   6.98,    -3.09, 4.98,  -3.75,   1.64,  -8.352, -2.54,
      2.85,    -5.84, -0.45,   8.43,  -2.87,   2.52,   -6.17,   -1.66, 3.73,  -4.96,   0.43};
  constexpr double kAzimuthDeg[8] = {6.354, 4.548, 2.732, 0.911, -0.911, -2.732, -4.548, -6.354};
  constexpr double kGroup_us = 2.665;
  VelodyneModel model{"VLS-128", 0xA1, 0.004, 20 * kGroup_us, 4, 1, 20 * kGroup_us, {}, {}};
  for (std::size_t i = 0; i < 128; ++i) {
    const std::size_t group = i / 8;
    model.lasers.push_back(
        {kVerticalDeg[i], kAzimuthDeg[i % 8], kGroup_us * static_cast<double>(group + group / 8)});
  }
  return model;
}

/// Manual of the S3: four lasers of each bank in 7.2 us, eight times 7.2 us are a sequence of both banks. (An
/// S2 takes 48 us for it: at most 48 us less from a packet's first sequence to its last.)
VelodyneModel make_hdl64e() {
  constexpr double kOfFour_us[4] = {0, 1.3, 2.5, 3.7};
  VelodyneModel model{"HDL-64E", std::nullopt, 0.002, 57.6, 2, 1, 57.6, {}, {}};
  model.corrections.resize(64);
  for (std::size_t i = 0; i < 64; ++i) {
    const auto four = static_cast<double>(i % 32 / 4);
    model.lasers.push_back({0, 0, 7.2 * four + kOfFour_us[i % 4]});
  }
  return model;
}

const std::vector<VelodyneModel>& models() {
  static const std::vector<VelodyneModel> all{
      make_puck("VLP-16", 0x22, {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15}),
      make_puck(
          "Puck-Hi-Res", 0x24,
          {-10, 0.667, -8.667, 2, -7.333, 3.333, -6, 4.667, -4.667, 6, -3.333, 7.333, -2, 8.667, -0.667, 10}),
      make_vlp32c(),
      make_hdl32(),
      make_hdl64e(),
      make_vls128()};
  return all;
}

}  // namespace

// Between 2.40 m (1.93 m) and 25.04 m, where the two distances were that it was calibrated at, the correction
// goes from the one to the other; the height's is their mean.
VelodynePoint corrected_point(const VelodyneCorrection& correction, double range_m, double azimuth,
                              double cos_vertical, double sin_vertical) {
  constexpr double kFar_m = 25.04, kNearX_m = 2.40, kNearY_m = 1.93;
  const double c = std::cos(azimuth), s = std::sin(azimuth);
  double more_x_m = correction.range_m, more_y_m = correction.range_m;
  if (range_m < kFar_m) {
    const double level_m = (range_m + correction.range_m) * cos_vertical;
    const auto between = [&](double distance_m, double near_m, double near_more_m) {
      const double far = (distance_m - near_m) / (kFar_m - near_m);
      return far * correction.range_m + (1 - far) * near_more_m;
    };
    more_x_m = between(std::abs(level_m * s), kNearX_m, correction.near_x_m);
    more_y_m = between(std::abs(level_m * c), kNearY_m, correction.near_y_m);
  }
  return {(range_m + more_y_m) * cos_vertical * c + correction.aside_m * s,
          -(range_m + more_x_m) * cos_vertical * s + correction.aside_m * c,
          (range_m + (more_x_m + more_y_m) / 2) * sin_vertical + correction.up_m};
}

const VelodyneModel* find_velodyne_model(std::string_view name) {
  for (const VelodyneModel& model : models()) {
    if (model.name == name) return &model;
  }
  return nullptr;
}

std::string known_velodyne_models() {
  std::string names;
  for (const VelodyneModel& model : models()) names += (names.empty() ? "" : ", ") + std::string(model.name);
  return names;
}

}  // namespace gvom::ingest
