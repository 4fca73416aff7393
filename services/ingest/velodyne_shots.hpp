// The blocks of a Velodyne packet as shots: which firings there are, when, and how far the sensor turns
// meanwhile.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "services/ingest/velodyne_marks.hpp"
#include "services/ingest/velodyne_model.hpp"

namespace gvom::ingest {

inline constexpr int kVelodyneTurn = 36000;  ///< 1/100 degree.

/// A block of a packet, or two that hold the two returns of the same shots (dual return mode).
struct VelodyneShot {
  const std::uint8_t* first;
  const std::uint8_t* second;  ///< Null unless dual.
  std::int64_t time_ns;
  int bank;
  int sequence;  ///< In the packet.
  int azimuth;   ///< 1/100 degree.
  int gap;       ///< Azimuth from here to the next sequence, 1/100 degree.
};

/// Where the sensor was at the newest packet before.
struct VelodyneBefore {
  int azimuth;  ///< 1/100 degree.
  std::int64_t time_ns;
};

class VelodyneShots {
 public:
  /// `model` must outlive it.
  explicit VelodyneShots(const VelodyneModel& model) : model_(model) {}

  /// Blocks of a packet that hold shots; those behind the last whole sequence are padding.
  [[nodiscard]] int blocks_used(bool dual) const;
  /// Reads a packet's shots; returns how many blocks can't be.
  int read(const std::uint8_t* packet, std::int64_t time_ns, bool dual,
           const std::optional<VelodyneBefore>& before);

  [[nodiscard]] const VelodyneShot* begin() const { return shots_.data(); }
  [[nodiscard]] const VelodyneShot* end() const { return shots_.data() + count_; }

  /// How many sequences a turn has, by the mean gap since `begin_sweep`.
  [[nodiscard]] double sequences_a_turn() const;
  void begin_sweep();

 private:
  void fill_gaps(std::int64_t time_ns, bool dual, const std::optional<VelodyneBefore>& before);
  void note_gap(int gap);

  const VelodyneModel& model_;
  std::array<VelodyneShot, kVelodyneBlocks> shots_{};
  std::size_t count_ = 0;
  int last_gap_ = 0;
  std::int64_t gap_sum_ = 0;  // of the open sweep
  int gap_count_ = 0;
};

}  // namespace gvom::ingest
