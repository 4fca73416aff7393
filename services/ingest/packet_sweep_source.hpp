// A source of sweeps made of a packet source and a decoder.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/ingest/arrival_clock.hpp"
#include "services/ingest/decoder.hpp"
#include "services/ingest/packet.hpp"
#include "services/ingest/port_owner.hpp"

namespace gvom::ingest {

class PacketSweepSource final : public Source {
 public:
  /// `packets` and `decoder` report to `state`. Of `options`, the clock is of this part. With `only_from`,
  /// packets of other senders are not used.
  PacketSweepSource(std::unique_ptr<SourceState> state, std::unique_ptr<PacketSource> packets,
                    std::unique_ptr<Decoder> decoder, const SourceOptions& options,
                    std::optional<Address> only_from = {});

  tl::expected<SourceEvent, std::string> next(Sweep& out, std::chrono::milliseconds timeout) override;
  tl::expected<void, std::string> rewind() override;
  [[nodiscard]] bool is_live() const override { return packets_->is_live(); }
  [[nodiscard]] double most_packets_per_s() const override { return decoder_->most_packets_per_s(); }
  [[nodiscard]] std::size_t most_returns() const override { return decoder_->most_returns(); }
  void set_time_hint(std::int64_t stamp_ns) override { decoder_->set_time_hint(stamp_ns - clock_offset_ns_); }
  [[nodiscard]] const SourceCounters& counters() const override { return state_->counters; }
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return state_->warnings; }

 private:
  bool decode(const Packet& packet, Sweep& out);
  bool wall_was_set(const Packet& packet);
  bool use(const Packet& packet, Sweep& out);
  /// Gives a whole sweep the times that its reader asked for.
  SourceEvent hand_out(Sweep& out) const;
  bool decode_live(const Packet& packet, Sweep& out);
  bool decode_recorded(const Packet& packet, Sweep& out);
  /// The open sweep ends before another sensor's packets; true if `out` holds it.
  bool change_sensor(Sweep& out);
  bool withhold(Sweep& out);
  void count_foreign(const Packet& packet);
  void count_second(const Packet& packet);
  void warn_of_other(const KindText& kind);
  void warn_of_second(const Packet& packet);
  bool takes_over(const Packet& packet);
  void warn_if_nothing_fits(std::size_t packet_size);
  tl::expected<SourceEvent, std::string> end(Sweep& out);

  std::unique_ptr<SourceState> state_;
  std::unique_ptr<PacketSource> packets_;
  std::unique_ptr<Decoder> decoder_;
  std::optional<ArrivalClock> arrival_;
  bool clock_is_new_ = false;                  // the sensor changed
  std::optional<std::int64_t> wall_ahead_ns_;  // of CLOCK_MONOTONIC, live
  int wall_differs_ = 0;                       // packets running
  std::int64_t clock_offset_ns_;
  std::optional<Address> only_from_;
  PortOwner owner_;                   // live
  std::optional<Address> sensor_;     // in a recording: who sends
  std::int64_t heard_ns_ = 0;         // in a recording: capture time of the sensor's newest packet
  RestartDetector other_sensor_;      // in a recording
  std::optional<std::string> error_;  // to be told after the last sweep
  bool ended_ = false;
  bool warned_of_other_ = false;
  bool warned_of_second_ = false;
  bool anything_fits_ = false;
  int unrecognised_ = 0;  // packets before the first that the decoder recognises
};

}  // namespace gvom::ingest
