// UDP payloads, and where they come from: a recording or a socket.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/ingest/address.hpp"
#include "services/ingest/source.hpp"

namespace gvom::ingest {

/// The payload of one UDP datagram. `data` stays valid until the source's next call.
struct Packet {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
  /// When the kernel had it, live or in the recording's capture: Unix time, of a clock that may be set.
  std::int64_t capture_ns = 0;
  std::int64_t received_ns = 0;   ///< The same on CLOCK_MONOTONIC; 0 in a recording.
  std::int64_t suspended_ns = 0;  ///< How long the machine had been suspended until then, live.
  Address source{};               ///< The sender.
  std::uint16_t port = 0;         ///< The destination port.
};

/// What the parts of one source report to.
struct SourceState {
  SourceCounters counters;
  std::vector<std::string> warnings;
};

enum class PacketEvent { packet, idle, end };

class PacketSource {
 public:
  virtual ~PacketSource() = default;

  /// The next payload; what is no UDP payload is counted and passed over. Live: `idle` after `timeout`.
  virtual tl::expected<PacketEvent, std::string> next(Packet& out, std::chrono::milliseconds timeout) = 0;

  /// Starts a recording again; an error for a live source.
  virtual tl::expected<void, std::string> rewind() = 0;

  [[nodiscard]] virtual bool is_live() const = 0;
};

}  // namespace gvom::ingest
