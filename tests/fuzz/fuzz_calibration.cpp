// The calibration file of an HDL-64E.
#include <cmath>

#include "services/ingest/velodyne_calibration.hpp"
#include "tests/fuzz/memory_file.hpp"

using namespace gvom;
using namespace gvom::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MemoryFile file;
  file.set(data, size);
  const auto model = ingest::read_velodyne_calibration(file.path());
  require(model || !model.error().empty(), "an error says what it is");
  if (!model) return 0;
  require(model->lasers.size() == 64 && model->corrections.size() == 64, "all lasers are there");
  for (const ingest::VelodyneLaser& laser : model->lasers)
    require(std::abs(laser.vertical_deg) < 90 && std::isfinite(laser.azimuth_deg), "angles are angles");
  return 0;
}
