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

/// A sequence is a block or, of sensors with several banks of 32 lasers, a block of each bank.
struct VelodyneModel {
  std::string_view name;
  std::optional<std::uint8_t> model_byte;  ///< Of its packets; some firmware sends another.
  double range_unit_m = 0.002;
  double sequence_us = 0;             ///< From a sequence's first laser to the next one's.
  int banks = 1;                      ///< 1, or 4 (VLS-128).
  int firings = 1;                    ///< Times that all lasers fire within a sequence.
  double firing_us = 0;               ///< From one of these to the next.
  std::vector<VelodyneLaser> lasers;  ///< The 32 measurements of a block, in order, bank after bank.
};

/// Null for a name that is not one of known_velodyne_models().
const VelodyneModel* find_velodyne_model(std::string_view name);

/// The names, for messages.
std::string known_velodyne_models();

}  // namespace gvom::ingest
