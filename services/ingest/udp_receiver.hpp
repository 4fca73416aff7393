// The UDP payloads that a live sensor sends.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "services/ingest/packet.hpp"
#include "services/ingest/udp_socket.hpp"

namespace gvom::ingest {

class UdpReceiver final : public PacketSource {
 public:
  /// See open_udp_socket. `state` must outlive the receiver. Counts `kernel_drops`.
  static tl::expected<std::unique_ptr<UdpReceiver>, SourceError> open(const UdpOptions& options,
                                                                      SourceState& state);
  ~UdpReceiver() override;
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  /// Errors: the socket fails; the interface that was asked for, or on which the group was joined, is gone,
  /// or is another one by that name.
  tl::expected<PacketEvent, std::string> next(Packet& out, std::chrono::milliseconds timeout) override;
  tl::expected<void, std::string> rewind() override;
  [[nodiscard]] bool is_live() const override { return true; }

 private:
  UdpReceiver(int socket, UdpOptions options, SourceState& state);
  tl::expected<PacketEvent, std::string> receive(Packet& out);
  /// CLOCK_MONOTONIC of the moment at which the kernel had the packet that it stamped with `arrived_ns`.
  std::int64_t received_at(std::int64_t arrived_ns);
  [[nodiscard]] bool interface_is_gone() const;

  int socket_;
  UdpOptions options_;
  unsigned interface_;
  SourceState& state_;
  std::vector<std::uint8_t> buffer_;
  std::uint32_t kernel_drops_ = 0;  // as the kernel counts them, since the socket was opened
  std::int64_t suspended_ns_ = 0;   // until then
  std::int64_t not_before_ns_;      // of the packet before, or when the queue was last seen empty
};

}  // namespace gvom::ingest
