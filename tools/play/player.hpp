// Sends a recording's UDP payloads again, at the pace they were captured.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "services/ingest/packet.hpp"
#include "tools/play/udp_sender.hpp"

namespace gvom::play {

struct PlayOptions {
  double rate = 1.0;                                    ///< Times the recorded pace, > 0.
  bool loop = false;                                    ///< From the start again at the end, until a stop.
  std::optional<std::uint16_t> port;                    ///< All payloads go here.
  std::map<std::uint16_t, std::uint16_t> mapped_ports;  ///< Recorded to new; if any, other payloads stay.
};

struct PlaySummary {
  std::uint64_t packets = 0;  ///< Sent.
  std::uint64_t bytes = 0;
  std::uint64_t late = 0;      ///< Sent more than kLate after their time.
  std::uint64_t left_out = 0;  ///< To ports that are not played.
  std::uint64_t failed = 0;    ///< The system would not send them.
  std::uint64_t passes = 0;    ///< Whole passes through the recording.
  std::chrono::nanoseconds worst_delay{0};
};

inline constexpr std::chrono::milliseconds kLate{1};

/// Waits until the deadline; false if a stop was asked for.
using SleepUntil = std::function<bool(std::chrono::steady_clock::time_point)>;

/// Deadlines are absolute (a late packet does not delay the next); capture times that go back are sent at
/// once. Ends with the recording, at a stop, or with the source's error.
tl::expected<PlaySummary, std::string> play(ingest::PacketSource& recording, UdpSender& sender,
                                            const PlayOptions& options, const SleepUntil& sleep_until);

}  // namespace gvom::play
