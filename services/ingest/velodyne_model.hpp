// The lasers of the Velodyne sensors, as their manuals state them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gvom::ingest {

struct VelodyneLaser {
  double vertical_deg = 0;
  double azimuth_deg = 0;  ///< Added to the block's azimuth.
  double firing_us = 0;    ///< After the sequence's first laser.
};

/// What an HDL-64E's calibration adds to a measured range, and where its laser sits.
struct VelodyneCorrection {
  double range_m = 0;   ///< Added to ranges from 25.04 m on.
  double near_x_m = 0;  ///< ... nearer, sideways: down to this at 2.40 m aside,
  double near_y_m = 0;  ///< ... ahead: down to this at 1.93 m ahead.
  double up_m = 0;
  double aside_m = 0;
};

/// A sequence is a block or, of sensors with several banks of 32 lasers, a block of each bank.
struct VelodyneModel {
  std::string_view name;
  std::optional<std::uint8_t> model_byte;  ///< Of its packets; some firmware sends another.
  double range_unit_m = 0.002;
  double sequence_us = 0;             ///< From a sequence's first laser to the next one's.
  int banks = 1;                      ///< 1, 2 (HDL-64E) or 4 (VLS-128).
  int firings = 1;                    ///< Times that all lasers fire within a sequence.
  double firing_us = 0;               ///< From one of these to the next.
  std::vector<VelodyneLaser> lasers;  ///< The 32 measurements of a block, in order, bank after bank.
  std::vector<VelodyneCorrection> corrections;  ///< One for each laser of an HDL-64E; else none.
};

/// Where a corrected return lies, x forward at azimuth 0, y left, as the HDL-64E's manual computes it.
struct VelodynePoint {
  double x_m, y_m, z_m;
};
VelodynePoint corrected_point(const VelodyneCorrection& correction, double range_m, double azimuth,
                              double cos_vertical, double sin_vertical);

/// An HDL-64E is without angles, which its calibration has (read_velodyne_calibration()).
/// Null for a name that is not one of known_velodyne_models().
const VelodyneModel* find_velodyne_model(std::string_view name);

/// The names, for messages.
std::string known_velodyne_models();

}  // namespace gvom::ingest
