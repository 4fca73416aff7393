#include "services/ingest/velodyne_marks.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>

#include "services/ingest/bytes.hpp"

namespace gvom::ingest {
namespace {

constexpr std::size_t kModeAt = 1204;
constexpr std::size_t kModelAt = 1205;

struct KnownByte {
  std::uint8_t byte;
  const char* sensor;
};

// The maker's manuals; what can't be decoded is still named.
constexpr KnownByte kModels[] = {{0x21, "an HDL-32"},     {0x22, "a VLP-16"},  {0x23, "a VLP-32A or B"},
                                 {0x24, "a Puck Hi-Res"}, {0x28, "a VLP-32C"}, {0x31, "a Velarray"},
                                 {0xA1, "a VLS-128"}};

/// How many banks the flags of its blocks prove; 0: not one block has a flag.
int banks_of(const std::uint8_t* packet) {
  int banks = 0;
  for (int i = 0; i < kVelodyneBlocks; ++i) {
    const auto bank = velodyne_bank(packet + static_cast<std::size_t>(i) * kVelodyneBlockSize);
    if (bank) banks = std::max(banks, *bank < 2 ? *bank + 1 : 4);
  }
  return banks;
}

/// Of blocks of two banks: whether they take turns, as in an S2 and an S3. The first HDL-64E (S1) sent three
/// upper blocks to a lower one, and no time.
bool alternates(const std::uint8_t* packet) {
  for (int i = 0; i < kVelodyneBlocks; ++i) {
    const auto bank = velodyne_bank(packet + static_cast<std::size_t>(i) * kVelodyneBlockSize);
    if (bank && *bank != i % 2) return false;
  }
  return true;
}

/// Of blocks of two banks: whether each two sequences have one azimuth, and not all of them.
bool repeats_azimuths(const std::uint8_t* packet) {
  const auto azimuth = [packet](std::size_t block) {
    return load_le<std::uint16_t>(packet + block * kVelodyneBlockSize + 2);
  };
  return azimuth(0) == azimuth(2) && azimuth(4) == azimuth(6) && azimuth(8) == azimuth(10) &&
         azimuth(0) != azimuth(4) && azimuth(4) != azimuth(8);
}

void name_model(std::uint8_t byte, KindText& out) {
  const auto* const known = std::find_if(std::begin(kModels), std::end(kModels),
                                         [byte](const KnownByte& model) { return model.byte == byte; });
  std::snprintf(out.data(), out.size(), "%s, model byte 0x%02X",
                known != std::end(kModels) ? known->sensor : "no sensor that is known", byte);
}

}  // namespace

std::optional<int> velodyne_bank(const std::uint8_t* block) {
  const auto flag = load_le<std::uint16_t>(block);
  const auto* const found = std::find(std::begin(kVelodyneFlags), std::end(kVelodyneFlags), flag);
  if (found == std::end(kVelodyneFlags)) return std::nullopt;
  return static_cast<int>(found - kVelodyneFlags);
}

std::optional<VelodyneReturns> velodyne_returns(const std::uint8_t* packet) {
  const std::uint8_t mode = packet[kModeAt];
  if (mode == 0x37 || mode == 0x38) return VelodyneReturns::single;  // strongest, last
  if (mode == 0x39) return VelodyneReturns::dual;
  return std::nullopt;
}

bool VelodyneMarks::banks_fit(const std::uint8_t* packet) const {
  return velodyne_bank(packet) && banks_of(packet) == banks && (banks != 2 || alternates(packet));
}

bool VelodyneMarks::fit(const std::uint8_t* packet) const {
  if (!banks_fit(packet)) return false;
  if (model_byte && packet[kModelAt] != *model_byte) return false;
  return returns || !model_byte || velodyne_returns(packet).has_value();
}

VelodyneReturns VelodyneMarks::returns_of(const std::uint8_t* packet) const {
  if (returns) return *returns;
  if (!model_byte) return repeats_azimuths(packet) ? VelodyneReturns::dual : VelodyneReturns::single;
  return velodyne_returns(packet).value_or(VelodyneReturns::single);
}

void VelodyneMarks::name(const std::uint8_t* packet, KindText& out) const {
  out[0] = '\0';
  const int found = banks_of(packet);
  if (found == 0 || fit(packet)) return;
  if (found == 2) {
    std::snprintf(out.data(), out.size(), "an HDL-64E%s, blocks DDFF",
                  alternates(packet) ? "" : " S1, which can't be read");
  } else if (found == 4 && packet[kModelAt] != 0xA1) {
    std::snprintf(out.data(), out.size(), "a VLS-128, blocks BBFF, but model byte 0x%02X", packet[kModelAt]);
  } else if (!model_byte || packet[kModelAt] != *model_byte) {
    name_model(packet[kModelAt], out);
  } else if (found != banks) {
    std::snprintf(out.data(), out.size(), "model byte 0x%02X, but no blocks DDFF", packet[kModelAt]);
  } else if (!returns && !velodyne_returns(packet)) {
    std::snprintf(out.data(), out.size(), "return mode 0x%02X, neither 0x37, 0x38 nor 0x39", packet[kModeAt]);
  }
}

}  // namespace gvom::ingest
