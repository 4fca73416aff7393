// The UDP payloads that a live sensor sends.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "services/ingest/packet.hpp"

namespace gvom::ingest {

inline constexpr int kWantedBuffer = 16 << 20;     // bytes, of the kernel's receive buffer
inline constexpr int kSufficientBuffer = 4 << 20;  // about 0.1 s of the largest sensors

class UdpReceiver final : public PacketSource {
 public:
  /// Binds to `port` (IPv4) on `bind_address`, or on every address if that is empty. `state` must outlive
  /// the receiver. Counts `kernel_drops`; warns if the kernel grants a receive buffer too small for a burst.
  static tl::expected<std::unique_ptr<UdpReceiver>, SourceError> open(std::uint16_t port,
                                                                      const std::string& bind_address,
                                                                      SourceState& state);
  ~UdpReceiver() override;
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  tl::expected<PacketEvent, std::string> next(Packet& out, std::chrono::milliseconds timeout) override;
  tl::expected<void, std::string> rewind() override;
  [[nodiscard]] bool is_live() const override { return true; }

 private:
  UdpReceiver(int socket, std::uint16_t port, SourceState& state);
  tl::expected<PacketEvent, std::string> receive(Packet& out);
  /// CLOCK_MONOTONIC of the moment at which the kernel had the packet that it stamped with `arrived_ns`.
  std::int64_t received_at(std::int64_t arrived_ns);

  int socket_;
  std::uint16_t port_;
  SourceState& state_;
  std::vector<std::uint8_t> buffer_;
  std::uint32_t kernel_drops_ = 0;  // as the kernel counts them, since the socket was opened
  std::int64_t
      not_before_ns_;  // the next packet came later: then the queue was empty, or came the one before
};

}  // namespace gvom::ingest
