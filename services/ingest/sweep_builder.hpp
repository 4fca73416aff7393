// Collects the returns of the open sweep and decides what becomes of it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/sweep.hpp"
#include "services/ingest/packet.hpp"
#include "services/ingest/source.hpp"

namespace gvom::ingest {

class SweepBuilder {
 public:
  /// Makes room for `options.max_returns` returns and `max_times` times at once.
  SweepBuilder(const SourceOptions& options, std::size_t max_times, SourceCounters& counters);

  /// Adds a time of the sensor; the index is for the returns measured then.
  std::uint32_t add_time(std::int64_t time_ns);

  /// Adds returns that share the time added last. What exceeds `max_returns` is counted.
  void append(const Return* returns, std::size_t count);

  /// The moment at which the sweep's newest packet was read.
  void set_received(const Packet& packet) {
    open_.received_ns = packet.received_ns;
    open_.suspended_ns = packet.suspended_ns;
  }

  [[nodiscard]] std::size_t times() const { return open_.times_ns.size(); }

  /// Ends the sweep, of which `fraction` (0 .. 1) of the columns came. Dropped (false) if that is under
  /// `min_sweep_fraction` or if there is no column at all; else moved to `out` and true.
  bool close(double fraction, bool complete, Sweep& out);

  void discard();

 private:
  double min_fraction_;
  std::size_t max_returns_;
  std::size_t max_times_;
  SourceCounters& counters_;
  Sweep open_;
  std::int64_t last_return_ns_ = 0;
};

}  // namespace gvom::ingest
