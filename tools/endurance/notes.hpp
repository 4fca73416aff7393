// What the processes of gvom-soak tell each other: the one on the bus and the one that sends packets to the
// one that keeps the book. Plain structs, for a socket pair.
#pragma once

#include <array>
#include <cstdint>

#include "ipc/messages.hpp"

namespace gvom::endurance {

template <typename T>
using PerLidar = std::array<T, kMaxLidars>;

/// Layers as they were heard, without their arrays.
struct LayersNote {
  std::uint64_t epoch;     ///< Of the round.
  std::uint64_t sequence;  ///< Of fusion's layers.
  std::uint64_t key;       ///< Which maps are in them: the same in each round.
  std::uint64_t checksum;  ///< Of the arrays and of where they lie.
  std::int64_t received_mono_ns;
  std::int64_t published_mono_ns;
  std::int64_t heard_mono_ns;
  std::uint64_t lost;  ///< By us, since we joined.
  std::uint32_t lidars;
  std::uint32_t missing;         ///< Lidars that are.
  PerLidar<std::uint64_t> maps;  ///< That fusion took or counted as lost, of each lidar.
};

/// A round of the packets began, or is through.
struct RoundNote {
  std::uint64_t epoch;
  std::int64_t mono_ns;
  std::uint64_t whole;           ///< 1: through, to the last packet.
  PerLidar<std::uint64_t> sent;  ///< Packets so far, in all rounds.
};

/// All ends of the bus are open; whether it is there still.
struct AliveNote {
  std::int64_t mono_ns;
  std::uint64_t voxel_maps;  ///< Heard so far.
};

}  // namespace gvom::endurance
