#include "services/ingest/velodyne_shots.hpp"

#include <cmath>

#include "services/ingest/bytes.hpp"

namespace gvom::ingest {
namespace {

constexpr double kMaxTurnsPerSecond = 25.0;

int azimuth_of(const std::uint8_t* block) {
  return load_le<std::uint16_t>(block + 2);
}

bool is_block(const std::uint8_t* block, int bank) {
  return velodyne_bank(block) == bank && azimuth_of(block) < kVelodyneTurn;
}

}  // namespace

int VelodyneShots::blocks_used(bool dual) const {
  const int sequence = model_.banks * (dual ? 2 : 1);
  return kVelodyneBlocks / sequence * sequence;
}

int VelodyneShots::read(const std::uint8_t* packet, std::int64_t time_ns, bool dual,
                        const std::optional<VelodyneBefore>& before) {
  const int step = dual ? 2 : 1;
  const bool banks_first = model_.banks == 2;  // HDL-64E: upper, lower, upper again, lower again
  int broken = 0;
  count_ = 0;
  for (int i = 0; i < blocks_used(dual); i += step) {
    const int bank = i / step % model_.banks;
    const int at = banks_first ? i - bank * (step - 1) : i;
    const std::uint8_t* block = packet + static_cast<std::size_t>(at) * kVelodyneBlockSize;
    const std::size_t apart = static_cast<std::size_t>(banks_first ? 2 : 1) * kVelodyneBlockSize;
    const std::uint8_t* second = dual ? block + apart : nullptr;
    if (!is_block(block, bank) || (dual && !is_block(second, bank))) {
      broken += step;
      continue;
    }
    const int sequence = i / (step * model_.banks);
    const std::int64_t since_ns = std::llround(sequence * model_.sequence_us * 1e3);
    shots_[count_++] = {block, second, time_ns + since_ns, bank, sequence, azimuth_of(block), 0};
  }
  fill_gaps(time_ns, dual, before);
  return broken;
}

/// The azimuth turns steadily from sequence to sequence; where a gap is not that of a turning sensor (the
/// field of view ends), the gap before stands in for it.
void VelodyneShots::fill_gaps(std::int64_t time_ns, bool dual, const std::optional<VelodyneBefore>& before) {
  const bool one_sequence = blocks_used(dual) == model_.banks * (dual ? 2 : 1);  // back to the packet before
  if (count_ > 0 && one_sequence && before && time_ns > before->time_ns) {
    const int turned = (shots_[0].azimuth - before->azimuth + kVelodyneTurn) % kVelodyneTurn;
    const auto since_ns = static_cast<double>(time_ns - before->time_ns);
    note_gap(static_cast<int>(std::lround(turned * model_.sequence_us * 1e3 / since_ns)));
  }
  for (std::size_t i = 0; i < count_; ++i) {
    VelodyneShot& shot = shots_[i];
    for (std::size_t k = i + 1; k < count_; ++k) {
      const VelodyneShot& next = shots_[k];
      if (next.bank != shot.bank) continue;
      note_gap((next.azimuth - shot.azimuth + kVelodyneTurn) % kVelodyneTurn /
               (next.sequence - shot.sequence));
      break;
    }
    shot.gap = last_gap_;
  }
}

void VelodyneShots::note_gap(int gap) {
  if (gap > kMaxTurnsPerSecond * kVelodyneTurn * model_.sequence_us * 1e-6) return;
  last_gap_ = gap;
  gap_sum_ += gap;
  ++gap_count_;
}

double VelodyneShots::sequences_a_turn() const {
  if (gap_sum_ == 0) return kVelodyneTurn;
  return static_cast<double>(kVelodyneTurn) * gap_count_ / static_cast<double>(gap_sum_);
}

void VelodyneShots::begin_sweep() {
  gap_sum_ = 0;
  gap_count_ = 0;
}

}  // namespace gvom::ingest
