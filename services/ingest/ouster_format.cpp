#include "services/ingest/ouster_format.hpp"

#include "services/ingest/bytes.hpp"

namespace gvom::ingest {
namespace {

constexpr OusterLayout kLayouts[] = {
    {OusterProfile::legacy, "LEGACY", 0, 16, 12, 4, 0},
    {OusterProfile::rng15, "RNG15_RFL8_NIR8", 32, 12, 4, 0, 32},
    {OusterProfile::rng19, "RNG19_RFL8_SIG16_NIR16", 32, 12, 12, 0, 32},
    {OusterProfile::rng19_dual, "RNG19_RFL8_SIG16_NIR16_DUAL", 32, 12, 16, 0, 32},
};

}  // namespace

std::optional<OusterLayout> find_ouster_layout(std::string_view profile) {
  for (const OusterLayout& layout : kLayouts) {
    if (layout.name == profile) return layout;
  }
  return std::nullopt;
}

const OusterLayout& legacy_ouster_layout() {
  return kLayouts[0];
}

std::string supported_ouster_profiles() {
  std::string names;
  for (const OusterLayout& layout : kLayouts) names += (names.empty() ? "" : ", ") + std::string(layout.name);
  return names;
}

OusterColumn read_ouster_column(const OusterLayout& layout, const std::uint8_t* column, std::size_t beams) {
  OusterColumn out{load_le<std::uint64_t>(column), load_le<std::uint16_t>(column + 8), 0, false};
  if (layout.profile == OusterProfile::legacy) {
    const std::uint8_t* status = column + layout.column_header + beams * layout.pixel;
    out.frame_id = load_le<std::uint16_t>(column + 10);
    out.valid = load_le<std::uint32_t>(status) == 0xFFFFFFFFu;
  } else {
    out.valid = (load_le<std::uint16_t>(column + 10) & 1) != 0;
  }
  return out;
}

}  // namespace gvom::ingest
