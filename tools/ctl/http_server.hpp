// The little of HTTP that a scraper needs: GET of one text, one request a connection.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <tl/expected.hpp>

namespace gvom::ctl {

/// One thread: connections are served within `run_for` alone.
class HttpServer {
 public:
  using Text = std::function<std::string()>;

  /// Answers GET `path` with `text`; anything else with 404 or 405. Errors: `listen` cannot be bound.
  static tl::expected<std::unique_ptr<HttpServer>, std::string> open(
      const boost::asio::ip::tcp::endpoint& listen, const std::string& path, Text text);

  void run_for(std::chrono::milliseconds duration);
  [[nodiscard]] boost::asio::ip::tcp::endpoint endpoint() const;

 private:
  HttpServer(std::string path, Text text) : path_(std::move(path)), text_(std::move(text)) {}
  void accept();

  boost::asio::io_context context_{1};
  boost::asio::ip::tcp::acceptor acceptor_{context_};
  std::string path_;
  Text text_;
};

/// IPV4:PORT.
tl::expected<boost::asio::ip::tcp::endpoint, std::string> parse_endpoint(const std::string& text);

}  // namespace gvom::ctl
