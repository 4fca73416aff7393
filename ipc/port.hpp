// The ends of a topic, whatever its message: loaned chunks out, checked chunks in. The typed ends are built
// on these. Ports are not thread-safe: use a port, its loans and its chunks in one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "ipc/error.hpp"
#include "ipc/runtime.hpp"
#include "ipc/topic.hpp"

namespace gvom::ipc {

class Waiter;
struct OutPortState;
struct InPortState;

/// A chunk of shared memory to write. Goes back to its pool if it is not published.
class Loan {
 public:
  Loan() = default;
  Loan(std::shared_ptr<OutPortState> port, std::byte* data);
  Loan(Loan&& other) noexcept;
  Loan& operator=(Loan&& other) noexcept;
  ~Loan();

  [[nodiscard]] std::byte* data() const { return data_; }

 private:
  friend class OutPort;
  std::shared_ptr<OutPortState> port_;
  std::byte* data_ = nullptr;
};

/// A received message, in place in shared memory, read-only. Goes back when this is destroyed; without a port
/// it is a view of memory that somebody else keeps.
class Chunk {
 public:
  Chunk() = default;
  Chunk(std::shared_ptr<InPortState> port, const std::byte* data);
  Chunk(Chunk&& other) noexcept;
  Chunk& operator=(Chunk&& other) noexcept;
  ~Chunk();

  [[nodiscard]] const std::byte* data() const { return data_; }
  /// Whose it is: a number of its own for each publisher in a broker's life. 0 without a port.
  [[nodiscard]] std::uint64_t publisher() const;

 private:
  std::shared_ptr<InPortState> port_;
  const std::byte* data_ = nullptr;
};

class OutPort {
 public:
  static Expected<OutPort> open(Runtime& runtime, const Topic& topic);

  /// At least `bytes`, aligned to 64; holds old data. Errors: too_large, exhausted. At most 8 at a time.
  Expected<Loan> loan(std::size_t bytes);

  /// Fills the MessageHeader at the chunk's start and sends. `bytes`: of the message, header and arrays.
  /// Returns the message's sequence number.
  std::uint64_t publish(Loan&& loan, std::size_t bytes, std::int64_t stamp_ns, std::uint64_t epoch);

  [[nodiscard]] bool has_subscribers() const;
  [[nodiscard]] std::uint64_t sequence() const;  ///< Of the newest message; 0: none yet.

 private:
  explicit OutPort(std::shared_ptr<OutPortState> state);
  std::shared_ptr<OutPortState> state_;
};

/// What came in and what did not.
struct InCounters {
  std::uint64_t received = 0;         ///< Handed out.
  std::uint64_t lost = 0;             ///< Gaps in the publishers' sequences.
  std::uint64_t refused_foreign = 0;  ///< Not a gvom message: too short, or another magic number.
  std::uint64_t refused_type = 0;
  std::uint64_t refused_version = 0;
  std::uint64_t refused_size =
      0;  ///< Sizes or offsets that contradict each other or the chunk; what cannot be.
  std::uint64_t refused_held = 0;  ///< Lost because this reader holds too many chunks already.
  std::uint64_t publishers = 0;    ///< Publishers seen so far: a restarted one is a new one.

  [[nodiscard]] std::uint64_t refused() const {
    return refused_foreign + refused_type + refused_version + refused_size + refused_held;
  }
};

class InPort {
 public:
  static Expected<InPort> open(Runtime& runtime, const Topic& topic);

  /// The oldest message in the queue that is as its topic says; others are refused, counted and skipped.
  std::optional<Chunk> take();

  [[nodiscard]] bool has_data() const;
  [[nodiscard]] const InCounters& counters() const;

  /// Why messages were refused, in words, each reason once: for the log.
  std::optional<std::string> new_refusal();
  /// Why the newest of them was, in words; empty if none was.
  [[nodiscard]] const std::string& newest_refusal() const;

 private:
  friend class Waiter;
  explicit InPort(std::shared_ptr<InPortState> state);
  std::shared_ptr<InPortState> state_;
};

}  // namespace gvom::ipc
