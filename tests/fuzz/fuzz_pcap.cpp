// Capture files: pcap and pcapng, whatever is in them.
#include "services/ingest/pcap_reader.hpp"
#include "tests/fuzz/memory_file.hpp"

using namespace gvom;
using namespace gvom::fuzz;

namespace {

/// Payloads up to the end or an error.
std::size_t count_packets(ingest::PcapReader& reader) {
  std::size_t count = 0;
  for (ingest::Packet packet;; ++count) {
    const auto event = reader.next(packet, std::chrono::milliseconds(0));
    if (!event || *event == ingest::PacketEvent::end) return count;
    require(packet.capture_ns >= 0, "a capture time is Unix time");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MemoryFile file;
  file.set(data, size);
  ingest::SourceState state;
  auto reader = ingest::PcapReader::open(file.path(), std::nullopt, state);
  if (!reader) return 0;
  const std::size_t first = count_packets(**reader);
  const bool packed = size >= 2 && data[0] == 0x1F && data[1] == 0x8B;
  require(packed || (*reader)->records() <= size, "a record takes room in its file");
  require((*reader)->rewind().has_value(), "what was opened once opens again");
  require(count_packets(**reader) == first, "a recording read again is the same");
  return 0;
}
