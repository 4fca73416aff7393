// Captured frames of every link type, to UDP payloads: fragments too. First byte: the link type; then frames,
// each behind its length (two bytes) and the time since the one before (one byte, 10 ms).
#include <pcap/dlt.h>

#include <memory>
#include <vector>

#include "services/ingest/frames.hpp"
#include "tests/fuzz/input.hpp"

using namespace gvom;
using namespace gvom::fuzz;

namespace {

struct Parser {
  Parser(int link_type, std::optional<std::uint16_t> port) : frames(link_type, port, counters) {}
  ingest::SourceCounters counters;
  ingest::FrameParser frames;
};

/// Kept from input to input, for the room of their fragments: finish() makes them as new.
std::vector<std::unique_ptr<Parser>> make_parsers() {
  std::vector<std::unique_ptr<Parser>> parsers;
  for (const int link_type : {DLT_EN10MB, DLT_LINUX_SLL, DLT_LINUX_SLL2, DLT_NULL, DLT_LOOP, DLT_RAW,
                              DLT_IPV4, DLT_IPV6, DLT_PPP}) {
    require(ingest::FrameParser::supports(link_type), "the link type is known");
    parsers.push_back(std::make_unique<Parser>(link_type, std::nullopt));
    parsers.push_back(std::make_unique<Parser>(link_type, 7502));
  }
  return parsers;
}

/// Every byte is read, so that the sanitizer sees where they lie.
void touch(const ingest::Packet& packet) {
  unsigned sum = 0;
  for (std::size_t i = 0; i < packet.size; ++i) sum += packet.data[i];
  volatile unsigned sink = sum;
  (void)sink;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto kParsers = make_parsers();
  Input input(data, size);
  ingest::FrameParser& frames = kParsers[input.byte() % kParsers.size()]->frames;
  std::int64_t time_ns = 0;
  while (!input.empty()) {
    const auto length = input.value<std::uint16_t>();
    time_ns += std::int64_t{input.byte()} * 10'000'000;
    const ingest::Bytes bytes = input.take(length);
    const std::vector<std::uint8_t> frame(bytes.data, bytes.data + bytes.size);  // with nothing behind it
    ingest::Packet packet;
    if (!frames.parse({frame.data(), frame.size()}, time_ns, packet)) continue;
    require(packet.size <= 65535, "a payload fits its datagram");
    touch(packet);
  }
  frames.finish();
  return 0;
}
