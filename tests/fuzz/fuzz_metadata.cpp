// The JSON that an Ouster sensor says of itself, and a decoder made of it.
#include "services/ingest/ouster_decoder.hpp"
#include "tests/fuzz/memory_file.hpp"

using namespace gvom;
using namespace gvom::fuzz;

namespace {

void check(const ingest::OusterMetadata& metadata) {
  require(metadata.beams() > 0 && metadata.beams() == metadata.beam_azimuth_deg.size(),
          "beams have both angles");
  require(metadata.packet_size() <= 65507, "a packet fits a datagram");
  require(metadata.window_columns() >= 1 && metadata.window_columns() <= metadata.columns_per_frame,
          "the window is in the frame");
}

/// One packet whose columns are all valid or, in the profiles where zeros are not, none.
void decode(const ingest::OusterMetadata& metadata) {
  constexpr std::size_t kMaxReturns = 1000;
  ingest::SourceState state;
  ingest::OusterDecoder decoder(metadata, {0.0, kMaxReturns}, state);
  Sweep sweep;
  for (const std::uint8_t byte : {std::uint8_t{0}, std::uint8_t{0xFF}, std::uint8_t{1}}) {
    const std::vector<std::uint8_t> bytes(metadata.packet_size(), byte);
    ingest::Packet packet;
    packet.data = bytes.data();
    packet.size = bytes.size();
    if (!decoder.recognises(packet)) continue;  // of another mode, by its columns
    if (decoder.decode(packet, sweep)) check_sweep(sweep, kMaxReturns);
  }
  if (decoder.finish(sweep)) check_sweep(sweep, kMaxReturns);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MemoryFile file;
  file.set(data, size);
  std::vector<std::string> warnings;
  const auto metadata = ingest::read_ouster_metadata(file.path(), warnings);
  require(metadata || !metadata.error().empty(), "an error says what it is");
  if (!metadata) return 0;
  check(*metadata);
  constexpr int kMostColumns = 256;  // more only take longer
  if (metadata->columns_per_frame <= kMostColumns) decode(*metadata);
  return 0;
}
