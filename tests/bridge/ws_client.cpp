#include "tests/bridge/ws_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

namespace gvom::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;

struct WsClient::State {
  asio::io_context io;
  websocket::stream<beast::tcp_stream> socket{io};
  std::string subprotocol;
};

WsClient::WsClient(std::unique_ptr<State> state) : state_(std::move(state)) {}
WsClient::~WsClient() = default;

std::unique_ptr<WsClient> WsClient::connect(std::uint16_t port, const std::string& subprotocol) {
  auto state = std::make_unique<State>();
  beast::error_code fault;
  beast::get_lowest_layer(state->socket).socket().connect({asio::ip::make_address("127.0.0.1"), port}, fault);
  if (fault) return nullptr;
  state->socket.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    request.set(beast::http::field::sec_websocket_protocol, subprotocol);
  }));
  websocket::response_type response;
  state->socket.handshake(response, "127.0.0.1:" + std::to_string(port), "/", fault);
  if (fault) return nullptr;
  state->subprotocol = std::string(response[beast::http::field::sec_websocket_protocol]);
  state->socket.read_message_max(0);
  return std::unique_ptr<WsClient>(new WsClient(std::move(state)));
}

std::optional<WsMessage> WsClient::read() {
  beast::flat_buffer buffer;
  std::optional<WsMessage> message;
  beast::get_lowest_layer(state_->socket).expires_after(std::chrono::seconds(30));
  state_->socket.async_read(buffer, [&](beast::error_code fault, std::size_t) {
    if (fault) return;
    const auto* first = static_cast<const std::uint8_t*>(buffer.cdata().data());
    message = WsMessage{state_->socket.got_text(), {first, first + buffer.size()}};
  });
  state_->io.restart();
  state_->io.run();
  return message;
}

std::optional<WsMessage> WsClient::read_data() {
  auto message = read();
  while (message && message->text) message = read();
  return message;
}

bool WsClient::send(const std::string& text) {
  beast::error_code fault;
  state_->socket.text(true);
  state_->socket.write(asio::buffer(text), fault);
  return !fault;
}

bool WsClient::send_binary(const std::string& bytes) {
  beast::error_code fault;
  state_->socket.binary(true);
  state_->socket.write(asio::buffer(bytes), fault);
  return !fault;
}

bool WsClient::subscribe(std::uint32_t id, std::uint32_t channel) {
  return send(R"({"op":"subscribe","subscriptions":[{"id":)" + std::to_string(id) + R"(,"channelId":)" +
              std::to_string(channel) + "}]}");
}

const std::string& WsClient::subprotocol() const {
  return state_->subprotocol;
}

std::string raw_exchange(std::uint16_t port, const std::string& request, const std::string& then) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::string answer;
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    static_cast<void>(::send(socket, request.data(), request.size(), MSG_NOSIGNAL));
    char part[4096];
    pollfd readable{socket, POLLIN, 0};
    while (::poll(&readable, 1, 30'000) == 1) {
      const ssize_t size = ::recv(socket, part, sizeof part, 0);
      if (size <= 0) break;
      if (answer.empty()) static_cast<void>(::send(socket, then.data(), then.size(), MSG_NOSIGNAL));
      answer.append(part, static_cast<std::size_t>(size));
    }
  }
  ::close(socket);
  return answer;
}

}  // namespace gvom::test
