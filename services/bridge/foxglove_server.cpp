// All of Boost.Beast is in what this file compiles: it is slow.
#include "services/bridge/foxglove_server.hpp"

#include <mutex>
#include <thread>

#include <spdlog/spdlog.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

#include "services/bridge/address.hpp"
#include "services/bridge/web_visitor.hpp"

namespace gvom::bridge {

constexpr int kSocketBuffer_bytes = 1 << 18;  // what a slow client sees is no older than this holds

class FoxgloveServer::State {
 public:
  State(FoxgloveOptions options, asio::ip::address address) : address_(std::move(address)) {
    shared_.options = std::move(options);
    asio::post(io_, [this] { listen(); });
    thread_ = std::thread([this] { run(); });
  }
  ~State() {
    io_.stop();
    thread_.join();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  [[nodiscard]] const Shared& shared() const { return shared_; }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string problem() const {
    const std::lock_guard lock(mutex_);
    return problem_;
  }

  void offer(TopicId topic, std::int64_t stamp_ns, const ros::Blob& message) {
    const std::lock_guard lock(mutex_);
    Offered& offered = offered_[static_cast<std::size_t>(topic)];
    if (offered.message) ++shared_.replaced;
    offered = {stamp_ns, message};
    if (!std::exchange(posted_, true)) asio::post(io_, [this] { deliver(); });
  }

 private:
  struct Offered {
    std::int64_t stamp_ns = 0;
    ros::Blob message;
  };

  void run() {
    try {
      const auto work = asio::make_work_guard(io_);
      io_.run();
    } catch (const std::exception& error) {
      set_problem(std::string("the server ended: ") + error.what());
    }
  }

  void set_problem(std::string problem) {
    const std::lock_guard lock(mutex_);
    problem_ = std::move(problem);
  }

  void deliver() {
    std::array<Offered, kTopics.size()> offered;
    {
      const std::lock_guard lock(mutex_);
      offered.swap(offered_);
      posted_ = false;
    }
    for (std::size_t i = 0; i < offered.size(); ++i)
      if (offered[i].message)
        for (Client* client : shared_.clients_here)
          client->put(kTopics[i].id, offered[i].stamp_ns, offered[i].message);
  }

  void listen() {
    const tcp::endpoint place(address_, shared_.options.port);
    Fault fault;
    acceptor_.open(place.protocol(), fault);
    if (!fault) acceptor_.set_option(tcp::acceptor::reuse_address(true), fault);
    if (!fault) acceptor_.bind(place, fault);
    if (!fault) acceptor_.listen(kMostConnections, fault);
    if (!fault) {
      set_problem("");
      port_ = acceptor_.local_endpoint().port();
      spdlog::info("foxglove: at {}, port {}", address_.to_string(), port_.load());
      return accept();
    }
    Fault ignored;
    acceptor_.close(ignored);
    set_problem("cannot listen at " + address_.to_string() + ":" + std::to_string(place.port()) + ": " +
                fault.message() + " (bridge.foxglove.address, .port); it is tried again");
    after(shared_.options.retry, [this] { listen(); });
  }

  template <typename Call>
  void after(std::chrono::milliseconds pause, Call call) {
    timer_.expires_after(pause);
    timer_.async_wait([call](Fault fault) {
      if (!fault) call();
    });
  }

  void accept() {
    acceptor_.async_accept([this](Fault fault, tcp::socket socket) {
      if (fault) return after(std::chrono::milliseconds(100), [this] { accept(); });  // no files left
      Fault ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      socket.set_option(asio::socket_base::send_buffer_size(kSocketBuffer_bytes), ignored);
      if (shared_.connections < kMostConnections)
        std::make_shared<Visitor>(std::move(socket), shared_)->start();
      else
        ++shared_.refused;
      accept();
    });
  }

  const asio::ip::address address_;
  Shared shared_;
  mutable std::mutex mutex_;
  std::string problem_;
  std::array<Offered, kTopics.size()> offered_;
  bool posted_ = false;  // deliver() will be called
  std::atomic<std::uint16_t> port_{0};
  asio::io_context io_{1};  // goes before what its clients use
  tcp::acceptor acceptor_{io_};
  asio::steady_timer timer_{io_};
  std::thread thread_;
};

tl::expected<std::unique_ptr<FoxgloveServer>, std::string> FoxgloveServer::start(FoxgloveOptions options) {
  const auto address = parse_address(options.address);
  if (!address) return tl::unexpected(address.error());
  return std::unique_ptr<FoxgloveServer>(
      new FoxgloveServer(std::make_unique<State>(std::move(options), *address)));
}

FoxgloveServer::FoxgloveServer(std::unique_ptr<State> state) : state_(std::move(state)) {}
FoxgloveServer::~FoxgloveServer() = default;

bool FoxgloveServer::wants(const Topic& topic) const {
  return state_->shared().subscribers[static_cast<std::size_t>(topic.id)] > 0;
}

void FoxgloveServer::offer(const Topic& topic, std::int64_t stamp_ns, const ros::Blob& message) {
  state_->offer(topic.id, stamp_ns, message);
}

SinkCounters FoxgloveServer::counters() const {
  const Shared& shared = state_->shared();
  return {shared.sent, shared.bytes, shared.replaced, 0, shared.refused, shared.clients};
}

std::string FoxgloveServer::problem() const {
  return state_->problem();
}

std::uint16_t FoxgloveServer::port() const {
  return state_->port();
}

}  // namespace gvom::bridge
