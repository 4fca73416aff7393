// Ouster packets of every layout. First byte: bits 0, 1 and 5 the profile, 2 live, 3 no sweep is too small,
// 4 few returns fit.
#include <array>

#include "services/ingest/ouster_decoder.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/packets.hpp"
#include "tests/ingest/ouster_builder.hpp"

using namespace gvom;
using namespace gvom::fuzz;

namespace {

ingest::OusterMetadata metadata_of(const char* profile, const char* window) {
  test::OusterSensor sensor;
  sensor.profile = profile;
  sensor.window = window;
  const MemoryFile file;
  file.set(sensor.json());
  std::vector<std::string> warnings;
  const auto metadata = ingest::read_ouster_metadata(file.path(), warnings);
  require(metadata.has_value(), "our own metadata can be read");
  return *metadata;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array<ingest::OusterMetadata, 8> kSensors{
      metadata_of("LEGACY", "[0, 15]"),
      metadata_of("RNG15_RFL8_NIR8", "[12, 3]"),
      metadata_of("RNG19_RFL8_SIG16_NIR16", "[0, 7]"),
      metadata_of("RNG19_RFL8_SIG16_NIR16_DUAL", "[0, 15]"),
      metadata_of("FUSA_RNG15_RFL8_NIR8_DUAL", "[0, 15]"),
      metadata_of("RNG15_RFL8_NIR8_ZONE16", "[0, 15]"),
      metadata_of("RNG19_RFL8_SIG16_NIR16_RGB16", "[12, 3]"),
      metadata_of("RNG19_RFL8_SIG16_NIR16_RGB16_DUAL", "[0, 15]")};
  Input input(data, size);
  const std::uint8_t how = input.byte();
  const ingest::OusterMetadata& sensor = kSensors[(how & 3) | (how >> 5 & 1) << 2];
  const ingest::SourceOptions options{(how & 8) != 0 ? 0.0 : 0.5, (how & 16) != 0 ? 5U : 64U};
  auto state = std::make_unique<ingest::SourceState>();
  auto packets = std::make_unique<FuzzPackets>(input, sensor.packet_size(), (how & 4) != 0);
  auto decoder = std::make_unique<ingest::OusterDecoder>(sensor, options, *state);
  play(input, std::move(state), std::move(packets), std::move(decoder), options.max_returns);
  return 0;
}
