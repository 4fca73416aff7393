// The sink that Foxglove, Lichtblick and the bridge's own page connect to: a websocket, and the page's files
// by plain HTTP on the same port.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/bridge/sink.hpp"

namespace gvom::bridge {

/// What strangers can take of us.
inline constexpr std::size_t kMostClients = 16;            ///< Websockets.
inline constexpr std::size_t kMostConnections = 48;        ///< Those, and browsers that fetch files.
inline constexpr std::size_t kMostFrame_bytes = 64 << 10;  ///< Of a message from a client.

struct FoxgloveOptions {
  std::string vehicle;                    ///< What Foxglove calls the source.
  std::string address = "127.0.0.1";      ///< An IP address of this machine.
  std::uint16_t port = 8765;              ///< 0: any that is free.
  std::vector<std::string> origins;       ///< Of pages that may connect, beside our own.
  std::string page;                       ///< Its folder.
  std::chrono::milliseconds retry{1000};  ///< Until a port that was taken is tried again.
  /// For a request, an answer, a handshake, a closing.
  std::chrono::milliseconds patience{10'000};
};

/// All of the network is one thread of its own; whatever clients do, offer() hands over and returns. For each
/// subscription at most one message waits, and a newer one replaces it: memory is bounded, and a slow client
/// sees the newest. One that sends what no client sends is closed and counted as refused.
class FoxgloveServer : public Sink {
 public:
  /// The error is an address that is none. A port that is taken is a problem(), and tried again.
  static tl::expected<std::unique_ptr<FoxgloveServer>, std::string> start(FoxgloveOptions options);
  ~FoxgloveServer() override;

  [[nodiscard]] std::string_view name() const override { return "foxglove"; }
  [[nodiscard]] bool wants(const Topic& topic) const override;
  void offer(const Topic& topic, std::int64_t stamp_ns, const ros::Blob& message) override;
  [[nodiscard]] SinkCounters counters() const override;
  [[nodiscard]] std::string problem() const override;

  /// Where it listens; 0 while it does not.
  [[nodiscard]] std::uint16_t port() const;

 private:
  class State;
  explicit FoxgloveServer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace gvom::bridge
