#include "services/ingest/velodyne_model.hpp"

#include <cstddef>

namespace gvom::ingest {
namespace {

VelodyneModel make_vlp16() {
  constexpr double kVerticalDeg[16] = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
  VelodyneModel model{"VLP-16", 0x22, 0.002, 110.592, 2, 55.296, {}};
  for (std::size_t i = 0; i < 32; ++i) {
    const std::size_t laser = i % 16;
    const int firing = static_cast<int>(i / 16);
    model.lasers[i] = {kVerticalDeg[laser], 0.0,
                       firing * model.firing_us + 2.304 * static_cast<double>(laser), firing};
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
  VelodyneModel model{"VLP-32C", 0x28, 0.004, 55.296, 1, 55.296, {}};
  for (std::size_t i = 0; i < 32; ++i) {
    model.lasers[i] = {kVerticalDeg[i], kAzimuthDeg[i], 2.304 * static_cast<double>(i / 2), 0};
  }
  return model;
}

VelodyneModel make_hdl32() {
  constexpr double kVerticalDeg[32] = {-30.67, -9.33, -29.33, -8.00, -28.00, -6.67, -26.67, -5.33,
                                       -25.33, -4.00, -24.00, -2.67, -22.67, -1.33, -21.33, 0.00,
                                       -20.00, 1.33,  -18.67, 2.67,  -17.33, 4.00,  -16.00, 5.33,
                                       -14.67, 6.67,  -13.33, 8.00,  -12.00, 9.33,  -10.67, 10.67};
  VelodyneModel model{"HDL-32", 0x21, 0.002, 46.080, 1, 46.080, {}};
  for (std::size_t i = 0; i < 32; ++i) {
    model.lasers[i] = {kVerticalDeg[i], 0.0, 1.152 * static_cast<double>(i), 0};
  }
  return model;
}

const std::array<VelodyneModel, 3>& models() {
  static const std::array<VelodyneModel, 3> all{make_vlp16(), make_vlp32c(), make_hdl32()};
  return all;
}

}  // namespace

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
