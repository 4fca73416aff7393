// A small client of the Foxglove server, and a socket that says what it likes.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gvom::test {

struct WsMessage {
  bool text = false;
  std::vector<std::uint8_t> bytes;  ///< Of a text, too.
  [[nodiscard]] std::string as_text() const { return {bytes.begin(), bytes.end()}; }
};

class WsClient {
 public:
  /// Connects to 127.0.0.1; nothing if the server turns it away.
  static std::unique_ptr<WsClient> connect(std::uint16_t port,
                                           const std::string& subprotocol = "foxglove.websocket.v1");
  ~WsClient();

  /// The next message; nothing if none comes within 30 s, or the server has closed.
  std::optional<WsMessage> read();
  /// Texts are passed over.
  std::optional<WsMessage> read_data();
  bool send(const std::string& text);
  bool send_binary(const std::string& bytes);
  bool subscribe(std::uint32_t id, std::uint32_t channel);
  [[nodiscard]] const std::string& subprotocol() const;

 private:
  struct State;
  explicit WsClient(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Sends `request` to the port, `then` when something has come, and returns all that comes until the server
/// closes, or nothing has come for 30 s.
std::string raw_exchange(std::uint16_t port, const std::string& request, const std::string& then = "");

/// Waits up to 20 s until `done` says so.
template <typename Done>
bool eventually(Done done) {
  for (int i = 0; i < 10'000; ++i) {
    if (done()) return true;
    struct timespec pause = {0, 2'000'000};
    ::nanosleep(&pause, nullptr);
  }
  return false;
}

}  // namespace gvom::test
