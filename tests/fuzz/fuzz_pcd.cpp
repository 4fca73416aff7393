// Point clouds: every field of every point is read.
#include "services/ingest/pcd.hpp"
#include "tests/fuzz/input.hpp"

using namespace gvom;
using namespace gvom::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> scratch;
  const auto cloud = ingest::parse_pcd({data, size}, scratch);
  require(cloud || !cloud.error().empty(), "an error says what it is");
  if (!cloud) return 0;
  constexpr std::size_t kMaxRatio = 160;  // of bytes made to bytes read
  require(scratch.size() <= size * kMaxRatio, "the room is bounded by the file");
  double sum = 0;
  for (const ingest::PcdField& field : cloud->fields) {
    for (std::size_t point = 0; point < cloud->points; ++point) {
      sum += cloud->number(field, point);
      if (field.type != 'F') sum += static_cast<double>(cloud->integer(field, point));
    }
  }
  volatile double sink = sum;
  (void)sink;
  return 0;
}
