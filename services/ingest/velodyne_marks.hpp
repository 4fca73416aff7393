// What a Velodyne packet says of the sensor that sent it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "services/ingest/packet.hpp"
#include "services/ingest/velodyne_model.hpp"

namespace gvom::ingest {

constexpr std::size_t kVelodynePacketSize = 1206;
constexpr std::size_t kVelodyneBlockSize = 100;
constexpr int kVelodyneBlocks = 12;

/// The flags in front of the blocks, a bank of 32 lasers each.
constexpr std::uint16_t kVelodyneFlags[4] = {0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};

/// The bank that a block is of, 0 .. 3; nothing if it has no flag.
std::optional<int> velodyne_bank(const std::uint8_t* block);

/// What a packet holds of each shot.
enum class VelodyneReturns { single, dual };

/// As a packet's mode byte says; nothing if it is none that is known.
std::optional<VelodyneReturns> velodyne_returns(const std::uint8_t* packet);

/// What the packets of one source must say of themselves.
struct VelodyneMarks {
  std::optional<std::uint8_t> model_byte;  ///< Nothing for a sensor that sends none, nor a mode (HDL-64E).
  int banks = 1;                           ///< 1, 2 (HDL-64E) or 4 (VLS-128).
  /// In place of what the mode byte says.
  std::optional<VelodyneReturns> returns;

  /// True if a packet of 1206 bytes has these marks and a return mode that can be read.
  [[nodiscard]] bool fit(const std::uint8_t* packet) const;
  /// True if its blocks are flagged as a sensor with so many banks does: no option can say otherwise.
  [[nodiscard]] bool banks_fit(const std::uint8_t* packet) const;
  /// Of a packet that fits.
  [[nodiscard]] VelodyneReturns returns_of(const std::uint8_t* packet) const;
  /// Of a packet that does not fit, what it proves to be: "an HDL-32, model byte 0x21". Empty if it proves
  /// nothing.
  void name(const std::uint8_t* packet, KindText& out) const;
};

}  // namespace gvom::ingest
