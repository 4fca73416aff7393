// Velodyne packets of every model, and the clock that tells their hour. First byte: bits 0, 1 and 5 the
// model, 2 live, 3 no sweep is too small, 4 few returns fit.
#include "services/ingest/velodyne_decoder.hpp"
#include "tests/fuzz/packets.hpp"

using namespace gvom;
using namespace gvom::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr const char* kModels[8] = {"VLP-16",      "VLP-32C", "HDL-32",  "VLS-128",
                                      "Puck-Hi-Res", "HDL-64E", "VLS-128", "HDL-32"};
  constexpr std::size_t kPacketBytes = 1206;
  Input input(data, size);
  const std::uint8_t how = input.byte();
  const ingest::SourceOptions options{(how & 8) != 0 ? 0.0 : 0.5, (how & 16) != 0 ? 5U : 2000U};
  auto state = std::make_unique<ingest::SourceState>();
  auto packets = std::make_unique<FuzzPackets>(input, kPacketBytes, (how & 4) != 0);
  const ingest::VelodyneModel& model = *ingest::find_velodyne_model(kModels[(how & 3) | (how >> 5 & 1) << 2]);
  auto decoder = std::make_unique<ingest::VelodyneDecoder>(
      model, ingest::VelodyneMarks{model.model_byte, model.banks, std::nullopt}, options, *state);
  play(input, std::move(state), std::move(packets), std::move(decoder), options.max_returns);
  return 0;
}
