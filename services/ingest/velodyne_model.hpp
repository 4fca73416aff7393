// The lasers of the Velodyne sensors, as their manuals state them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace gvom::ingest {

struct VelodyneLaser {
  double vertical_deg = 0;
  double azimuth_deg = 0;  ///< Added to the block's azimuth.
  double firing_us = 0;    ///< After the block's first laser.
  int firing = 0;          ///< Which of the block's firing sequences.
};

struct VelodyneModel {
  std::string_view name;
  std::uint8_t product_id;  ///< The model byte of its packets; some firmware sends another.
  double range_unit_m;
  double block_us;                       ///< From a block's first laser to the next block's.
  int firings_per_block;                 ///< Times that all lasers fire within a block.
  double firing_us;                      ///< From one of these to the next.
  std::array<VelodyneLaser, 32> lasers;  ///< The 32 measurements of a block, in order.
};

/// VLP-16, VLP-32C or HDL-32; null for any other name.
const VelodyneModel* find_velodyne_model(std::string_view name);

/// The names, for messages.
std::string known_velodyne_models();

}  // namespace gvom::ingest
