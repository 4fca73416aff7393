#include "tools/ctl/http_server.hpp"

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <optional>
#include <utility>

namespace gvom::ctl {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

constexpr std::chrono::seconds kLongestRequest{5};
constexpr std::uint64_t kLongestBody = 0;
constexpr std::uint32_t kLongestHeader = 8192;

using Response = http::response<http::string_body>;

Response answer(const http::request<http::string_body>& request, const std::string& path,
                const HttpServer::Text& text) {
  Response response(http::status::ok, request.version());
  response.set(http::field::content_type, "text/plain; version=0.0.4; charset=utf-8");
  const beast::string_view target = request.target();
  if (target.substr(0, target.find('?')) != path) {
    response.result(http::status::not_found);
    response.body() = "only " + path + " is here\n";
  } else if (request.method() != http::verb::get) {
    response.result(http::status::method_not_allowed);
    response.set(http::field::allow, "GET");
  } else {
    response.body() = text();
  }
  response.keep_alive(false);
  response.prepare_payload();
  return response;
}

/// Lives until its connection is through or too slow.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(tcp::socket socket, const std::string& path, const HttpServer::Text& text)
      : stream_(std::move(socket)), path_(path), text_(text) {
    parser_.body_limit(kLongestBody);
    parser_.header_limit(kLongestHeader);
  }

  void start() {
    stream_.expires_after(kLongestRequest);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](const beast::error_code& error, std::size_t) {
                       if (!error) self->respond();
                     });
  }

 private:
  void respond() {
    response_ = answer(parser_.get(), path_, text_);
    http::async_write(stream_, response_, [self = shared_from_this()](const beast::error_code&, std::size_t) {
      beast::error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  http::request_parser<http::string_body> parser_;
  Response response_;
  const std::string& path_;
  const HttpServer::Text& text_;
};

}  // namespace

tl::expected<tcp::endpoint, std::string> parse_endpoint(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? "" : text.substr(colon + 1);
  const bool is_number = !port.empty() && port.size() <= 5 &&
                         port.find_first_not_of("0123456789") == std::string::npos &&
                         std::stoul(port) <= 65535;
  boost::system::error_code error;
  const auto address = asio::ip::make_address_v4(text.substr(0, std::min(colon, text.size())), error);
  if (error || !is_number)
    return tl::unexpected("'" + text + "' is not an IPv4 address and a port, such as 127.0.0.1:9464");
  return tcp::endpoint(address, static_cast<std::uint16_t>(std::stoul(port)));
}

tl::expected<std::unique_ptr<HttpServer>, std::string> HttpServer::open(const tcp::endpoint& listen,
                                                                        const std::string& path, Text text) {
  std::unique_ptr<HttpServer> server(new HttpServer(path, std::move(text)));
  boost::system::error_code error;
  server->acceptor_.open(listen.protocol(), error);
  if (!error) server->acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) server->acceptor_.bind(listen, error);
  if (!error) server->acceptor_.listen(tcp::acceptor::max_listen_connections, error);
  if (error) return tl::unexpected("port " + std::to_string(listen.port()) + ": " + error.message());
  server->accept();
  return server;
}

void HttpServer::accept() {
  acceptor_.async_accept([this](const boost::system::error_code& error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) std::make_shared<Session>(std::move(socket), path_, text_)->start();
    accept();
  });
}

void HttpServer::run_for(std::chrono::milliseconds duration) {
  context_.run_for(duration);
}

tcp::endpoint HttpServer::endpoint() const {
  return acceptor_.local_endpoint();
}

}  // namespace gvom::ctl
