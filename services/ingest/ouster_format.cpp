#include "services/ingest/ouster_format.hpp"

#include "services/ingest/bytes.hpp"

namespace gvom::ingest {
namespace {

using Header = OusterHeader;
using Range = OusterRange;

// The maker's sensor documentation and its SDK (ouster_client, packet formats). What is not range is not
// read: reflectivity, signal, near infrared, window, zones, colours.
constexpr OusterLayout kLayouts[] = {
    {"LEGACY", Header::none, Range::bits20, 12, 0, 0, 16, 4, 0},
    {"RNG15_RFL8_NIR8", Header::standard, Range::bits15_by_8, 4, 0},
    {"RNG15_RFL8_WIN8", Header::standard, Range::bits15_by_8, 4, 0},
    {"RNG15_RFL8_NIR8_DUAL", Header::standard, Range::bits15_by_8, 8, 4},
    {"FUSA_RNG15_RFL8_NIR8_DUAL", Header::fusa, Range::bits15_by_8, 8, 4},
    {"RNG15_RFL8_NIR8_ZONE16", Header::standard, Range::bits15_by_8, 8, 0},
    {"RNG19_RFL8_SIG16_NIR16", Header::standard, Range::bits19, 12, 0},
    {"RNG19_RFL8_SIG16_NIR16_ZONE16", Header::standard, Range::bits19, 12, 0},
    {"RNG19_RFL8_SIG16_NIR16_DUAL", Header::standard, Range::bits19, 16, 4},
    {"RNG19_RFL8_SIG16_ZONE16_DUAL", Header::standard, Range::bits19, 16, 4},
    {"RNG19_RFL8_SIG16_NIR16_RGB16", Header::standard, Range::bits19, 16, 0},
    {"RNG19_RFL8_SIG16_NIR16_RGB16_DUAL", Header::standard, Range::bits19, 20, 4},
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

std::uint16_t ouster_frame(const OusterLayout& layout, const std::uint8_t* packet) {
  return load_le<std::uint16_t>(packet + (layout.header == OusterHeader::fusa ? 4 : 2));
}

std::uint64_t ouster_serial(const OusterLayout& layout, const std::uint8_t* packet) {
  constexpr std::uint64_t kFiveBytes = 0xFFFFFFFFFF;
  return load_le<std::uint64_t>(packet + (layout.header == OusterHeader::fusa ? 11 : 7)) & kFiveBytes;
}

OusterColumn read_ouster_column(const OusterLayout& layout, const std::uint8_t* column, std::size_t beams) {
  OusterColumn out{load_le<std::uint64_t>(column), load_le<std::uint16_t>(column + 8), 0, 0, false};
  if (layout.header == OusterHeader::none) {
    const std::uint8_t* status = column + layout.column_header + beams * layout.pixel;
    out.frame_id = load_le<std::uint16_t>(column + 10);
    out.encoder = load_le<std::uint32_t>(column + 12);
    out.valid = load_le<std::uint32_t>(status) == 0xFFFFFFFFu;
  } else {
    out.valid = (load_le<std::uint16_t>(column + 10) & 1) != 0;
  }
  return out;
}

}  // namespace gvom::ingest
