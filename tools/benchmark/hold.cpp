#include "tools/benchmark/hold.hpp"

#include <cstdio>

#include "core/open_backend.hpp"
#include "tools/benchmark/samples.hpp"

namespace gvom::bench {

tl::expected<void, Failure> hold_gpu() {
  MapperConfig smallest;
  smallest.map.size_xy = smallest.map.size_z = kBrickEdge;
  DeviceExpected<OpenBackend<FusionBackend>> opened;
  const double ms = time_ms([&] { opened = open_fusion(Backend::cuda, {smallest, 1, 1, {}}); });
  if (!opened) return tl::make_unexpected(Failure(opened.error()));
  const std::string device = opened->details.substr(0, opened->details.rfind(": maps"));
  std::printf("%s: opened in %.2f s\n", device.c_str(), ms * 1e-3);
  std::fflush(stdout);
  while (std::getchar() != EOF) continue;
  return {};
}

}  // namespace gvom::bench
