#include "tests/cuda/gpu.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>

#include "core/open_backend.hpp"

namespace gvom::test {

bool has_gpu() {
  MapperConfig config;
  config.map = {0.5, 0.5, 8, 8};
  const auto opened = open_fusion(Backend::cuda, {config, 1, 1, {}});
  if (opened) return true;
  const char* required = std::getenv("GVOM_REQUIRE_GPU");
  if (required != nullptr && std::string(required) == "1") FAIL("no usable GPU: " << opened.error().what);
  WARN("SKIPPED: no usable GPU: " << opened.error().what);
  return false;
}

}  // namespace gvom::test
