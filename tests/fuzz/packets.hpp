// Packets of one size, each behind a byte that says how it comes.
#pragma once

#include <memory>
#include <utility>

#include "services/ingest/packet_sweep_source.hpp"
#include "tests/fuzz/input.hpp"

namespace gvom::fuzz {

/// Bits 0 and 1 of the byte: the sender; 2 to 4: the time since the packet before; 5: a byte is missing.
class FuzzPackets final : public ingest::PacketSource {
 public:
  FuzzPackets(Input& input, std::size_t packet_size, bool live)
      : input_(input), packet_size_(packet_size), live_(live) {}

  tl::expected<ingest::PacketEvent, std::string> next(ingest::Packet& out,
                                                      std::chrono::milliseconds) override {
    if (input_.empty()) return ingest::PacketEvent::end;
    const std::uint8_t how = input_.byte();
    const ingest::Bytes bytes = input_.take(packet_size_ - (how >> 5 & 1));
    time_ns_ += kSteps_ns[how >> 2 & 7];
    out = ingest::Packet{};
    out.data = bytes.data;
    out.size = bytes.size;
    (live_ ? out.received_ns : out.capture_ns) = time_ns_;
    out.source[0] = how & 3;
    return ingest::PacketEvent::packet;
  }
  tl::expected<void, std::string> rewind() override { return tl::unexpected(std::string("not for these")); }
  [[nodiscard]] bool is_live() const override { return live_; }

 private:
  static constexpr std::int64_t kSteps_ns[8] = {
      0,           1'000'000,         100'000'000,       1'000'000'000,
      -50'000'000, 1'800'000'000'000, 3'600'000'000'000, -3'600'000'000'000};

  Input& input_;
  std::size_t packet_size_;
  bool live_;
  std::int64_t time_ns_ = 1'700'000'000'000'000'000;
};

/// Everything that comes of the packets, checked. Of live ones, a hint stands before each sweep.
inline void play(Input& input, std::unique_ptr<ingest::SourceState> state,
                 std::unique_ptr<ingest::PacketSource> packets, std::unique_ptr<ingest::Decoder> decoder,
                 std::size_t max_returns) {
  constexpr std::int64_t kMaxStamp_ns = 4'000'000'000'000'000'000;  // what the bus lets through
  ingest::PacketSweepSource source(std::move(state), std::move(packets), std::move(decoder), {});
  Sweep sweep;
  for (;;) {
    if (source.is_live()) source.set_time_hint(input.value<std::int64_t>() % kMaxStamp_ns);
    const auto event = source.next(sweep, std::chrono::milliseconds(0));
    require(event.has_value(), "packets give no errors");
    if (*event == ingest::SourceEvent::kEnd) return;
    if (*event == ingest::SourceEvent::kSweep) check_sweep(sweep, max_returns);
  }
}

}  // namespace gvom::fuzz
