// Publisher and Subscriber of the messages of fixed size: Odometry, Progress, Health.
#pragma once

#include <cstring>
#include <optional>
#include <utility>

#include "ipc/port.hpp"

namespace gvom::ipc {

template <typename M>
class Publisher {
 public:
  static Expected<Publisher> open(Runtime& runtime) {
    return OutPort::open(runtime, topic_of<M>()).map([](OutPort&& port) {
      return Publisher(std::move(port));
    });
  }

  /// Sends a copy of `message` with its header filled in; returns its sequence number, or exhausted.
  Expected<std::uint64_t> publish(const M& message, std::int64_t stamp_ns, std::uint64_t epoch) {
    return port_.loan(sizeof(M)).map([&](Loan&& loan) {
      std::memcpy(loan.data(), &message, sizeof(M));
      return port_.publish(std::move(loan), sizeof(M), stamp_ns, epoch);
    });
  }

  [[nodiscard]] bool has_subscribers() const { return port_.has_subscribers(); }
  [[nodiscard]] std::uint64_t sequence() const { return port_.sequence(); }

 private:
  explicit Publisher(OutPort port) : port_(std::move(port)) {}
  OutPort port_;
};

/// A received message, read where it lies.
template <typename M>
class Sample {
 public:
  explicit Sample(Chunk chunk) : chunk_(std::move(chunk)) {}
  const M& operator*() const { return *reinterpret_cast<const M*>(chunk_.data()); }
  const M* operator->() const { return &**this; }
  /// Whose it is: a number of its own for each publisher in a broker's life.
  [[nodiscard]] std::uint64_t publisher() const { return chunk_.publisher(); }

 private:
  Chunk chunk_;
};

template <typename M>
class Subscriber {
 public:
  static Expected<Subscriber> open(Runtime& runtime) {
    return InPort::open(runtime, topic_of<M>()).map([](InPort&& port) {
      return Subscriber(std::move(port));
    });
  }

  /// The oldest unread message.
  std::optional<Sample<M>> take() {
    auto chunk = port_.take();
    if (!chunk) return std::nullopt;
    return Sample<M>(std::move(*chunk));
  }

  [[nodiscard]] bool has_data() const { return port_.has_data(); }
  [[nodiscard]] const InCounters& counters() const { return port_.counters(); }
  std::optional<std::string> new_refusal() { return port_.new_refusal(); }
  InPort& port() { return port_; }

 private:
  explicit Subscriber(InPort port) : port_(std::move(port)) {}
  InPort port_;
};

}  // namespace gvom::ipc
