// One HTTP request to the Foxglove server. Included by foxglove_server.cpp alone.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "services/bridge/foxglove_client.hpp"
#include "services/bridge/web.hpp"

namespace gvom::bridge {

inline constexpr std::uint32_t kMostHeader_bytes = 8 << 10;

inline std::string_view text_of(beast::string_view text) {
  return {text.data(), text.size()};
}

/// One request of a browser or of Foxglove: it becomes a Client, or gets a file.
class Visitor : public std::enable_shared_from_this<Visitor> {
 public:
  Visitor(tcp::socket&& socket, Shared& shared) : stream_(std::move(socket)), shared_(shared) {
    ++shared_.connections;
  }
  ~Visitor() { --shared_.connections; }
  Visitor(const Visitor&) = delete;
  Visitor& operator=(const Visitor&) = delete;

  void start() {
    parser_.header_limit(kMostHeader_bytes);
    stream_.expires_after(shared_.options.patience);
    http::async_read(stream_, incoming_, parser_, [self = shared_from_this()](Fault fault, std::size_t) {
      if (!fault) return self->answer();
      // Browsers connect in advance, and may never ask.
      const bool unused = fault == beast::error::timeout && !self->parser_.got_some();
      if (fault != http::error::end_of_stream && !unused) ++self->shared_.refused;
    });
  }

 private:
  void answer() {
    const Request& request = parser_.get();
    if (websocket::is_upgrade(request)) return upgrade(request);
    if (request.method() != http::verb::get)
      return tell(http::status::method_not_allowed, "only GET is known here\n");
    const auto file = web_file(shared_.options.page, text_of(request.target()));
    if (file) return send(http::status::ok, *file);
    tell(http::status::not_found, file.error() + "\nFoxglove connects to ws://" +
                                      std::string(text_of(request[http::field::host])) + "\n");
  }

  void upgrade(const Request& request) {
    const auto subprotocol = chosen_subprotocol(text_of(request[http::field::sec_websocket_protocol]));
    const bool allowed = is_allowed_origin(text_of(request[http::field::origin]),
                                           text_of(request[http::field::host]), shared_.options.origins);
    if (!allowed)
      return turn_away(http::status::forbidden, "not from this page: see bridge.foxglove.origins\n");
    if (!subprotocol)
      return turn_away(http::status::bad_request, "offer foxglove.websocket.v1 or foxglove.sdk.v1\n");
    if (incoming_.size() > 0)
      return turn_away(http::status::bad_request, "something came before the answer to the handshake\n");
    if (shared_.clients >= kMostClients)
      return turn_away(http::status::service_unavailable, "too many clients\n");
    stream_.expires_never();
    std::make_shared<Client>(std::move(stream_), shared_)->start(request, *subprotocol);
  }

  void turn_away(http::status status, std::string why) {
    ++shared_.refused;
    tell(status, std::move(why));
  }

  void tell(http::status status, std::string text) {
    send(status, {"text/plain; charset=utf-8", std::move(text)});
  }

  void send(http::status status, WebFile file) {
    response_.result(status);
    response_.set(http::field::content_type, file.type);
    response_.set(http::field::cache_control, "no-cache");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Content-Security-Policy",
                  "default-src 'self'; connect-src 'self' ws:; img-src 'self' data: blob:; "
                  "style-src 'self' 'unsafe-inline'; frame-ancestors 'none'");
    response_.body() = std::move(file.text);
    response_.keep_alive(false);
    response_.prepare_payload();
    stream_.expires_after(shared_.options.patience);
    http::async_write(stream_, response_, [self = shared_from_this()](Fault, std::size_t) {
      Fault ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  beast::tcp_stream stream_;
  Shared& shared_;
  beast::flat_buffer incoming_{kMostHeader_bytes};
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> response_;
};

}  // namespace gvom::bridge
