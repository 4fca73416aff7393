// One websocket of the Foxglove server. Included by foxglove_server.cpp alone: Boost.Beast is slow to
// compile.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "services/bridge/foxglove_protocol.hpp"
#include "services/bridge/foxglove_server.hpp"
#include "services/bridge/outbox.hpp"

namespace gvom::bridge {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Fault = beast::error_code;
using Request = http::request<http::empty_body>;

inline constexpr std::chrono::seconds kIdle{60};  // a client is asked after half of it whether it lives

class Client;

/// Shared by the network's thread, which runs all but the counters, and the bridge's.
struct Shared {
  FoxgloveOptions options;
  std::array<std::atomic<int>, kTopics.size()> subscribers{};
  std::atomic<std::uint64_t> sent{0}, bytes{0}, replaced{0}, refused{0}, clients{0};
  std::set<Client*> clients_here;
  std::size_t connections = 0;
};

/// One websocket. It lives as long as an operation of it is under way.
class Client : public std::enable_shared_from_this<Client> {
 public:
  Client(beast::tcp_stream&& stream, Shared& shared) : socket_(std::move(stream)), shared_(shared) {
    shared_.clients_here.insert(this);
    ++shared_.clients;
    ++shared_.connections;
  }
  ~Client() {
    for (const TopicId topic : outbox_.topics()) count_subscriber(topic, -1);
    shared_.clients_here.erase(this);
    --shared_.clients;
    --shared_.connections;
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void start(const Request& request, const std::string& subprotocol) {
    socket_.set_option(websocket::stream_base::timeout{shared_.options.patience, kIdle, true});
    socket_.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, subprotocol);
    }));
    socket_.read_message_max(kMostFrame_bytes);
    socket_.auto_fragment(false);
    socket_.async_accept(request, [self = shared_from_this()](Fault fault) {
      if (fault) return;
      static const std::string session =
          std::to_string(std::chrono::system_clock::now().time_since_epoch().count());
      self->texts_.push_back(server_info(self->shared_.options.vehicle, session));
      self->texts_.push_back(advertisement());
      self->write();
      self->read();
    });
  }

  void put(TopicId topic, std::int64_t stamp_ns, const ros::Blob& message) {
    shared_.replaced += outbox_.put(topic, stamp_ns, message);
    write();
  }

 private:
  void count_subscriber(TopicId topic, int by) { shared_.subscribers[static_cast<std::size_t>(topic)] += by; }

  void read() {
    socket_.async_read(incoming_,
                       [self = shared_from_this()](Fault fault, std::size_t) { self->take(fault); });
  }

  void take(Fault fault) {
    if (fault == websocket::error::message_too_big || fault == websocket::condition::protocol_violation)
      ++shared_.refused;
    if (fault) return;
    const auto data = incoming_.cdata();
    const bool understood = socket_.got_text() && obey({static_cast<const char*>(data.data()), data.size()});
    incoming_.consume(incoming_.size());
    understood ? read() : refuse();
  }

  bool obey(std::string_view text) {
    const auto request = read_request(text);
    if (!request) return false;
    for (const std::uint32_t id : request->unsubscribe)
      if (const auto topic = outbox_.unsubscribe(id)) count_subscriber(*topic, -1);
    for (const Subscription& subscription : request->subscribe) {
      if (!outbox_.subscribe(subscription)) return false;
      count_subscriber(subscription.topic, 1);
    }
    return true;
  }

  void refuse() {
    ++shared_.refused;
    socket_.async_close(websocket::close_code::policy_error, [self = shared_from_this()](Fault) {});
  }

  void write() {
    if (writing_) return;
    if (!texts_.empty()) {
      writing_ = true;
      socket_.text(true);
      socket_.async_write(asio::buffer(texts_.front()),
                          [self = shared_from_this()](Fault fault, std::size_t) {
                            self->texts_.pop_front();
                            self->written(fault);
                          });
    } else if ((message_ = outbox_.take())) {
      writing_ = true;
      head_ = data_head(message_->subscription, message_->stamp_ns);
      socket_.binary(true);
      const std::array<asio::const_buffer, 2> parts = {asio::buffer(head_), asio::buffer(*message_->bytes)};
      socket_.async_write(parts, [self = shared_from_this()](Fault fault, std::size_t size) {
        self->message_.reset();
        if (!fault) ++self->shared_.sent, self->shared_.bytes += size;
        self->written(fault);
      });
    }
  }

  void written(Fault fault) {
    writing_ = false;
    if (!fault) write();
  }

  websocket::stream<beast::tcp_stream> socket_;
  Shared& shared_;
  beast::flat_buffer incoming_;
  std::deque<std::string> texts_;
  Outbox outbox_;
  std::optional<Outbox::Message> message_;  // that is being written
  std::array<std::uint8_t, 13> head_{};
  bool writing_ = false;
};

}  // namespace gvom::bridge
