#include "services/ingest/velodyne_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "services/ingest/bytes.hpp"

namespace gvom::ingest {
namespace {

constexpr std::size_t kPacketSize = 1206;
constexpr std::size_t kBlockSize = 100;
constexpr std::uint16_t kBlockFlag = 0xEEFF;
constexpr std::uint8_t kDualReturn = 0x39;
constexpr int kTurn = 36000;     // 1/100 degree
constexpr int kMaxJitter = 100;  // the azimuth of a turning sensor goes back no further than this
constexpr double kMaxTurnsPerSecond = 25.0;
constexpr std::int64_t kMaxTurnNs = 500'000'000;  // the slowest turn is 0.2 s
constexpr std::size_t kMaxPackets = 2048;         // in half a second: HDL-32, dual return: 1808
constexpr std::uint32_t kHourUs = 3'600'000'000u;
constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180.0;

std::int64_t to_ns(double microseconds) {
  return std::llround(microseconds * 1e3);
}

bool is_block(const std::uint8_t* block) {
  return load_le<std::uint16_t>(block) == kBlockFlag && load_le<std::uint16_t>(block + 2) < kTurn;
}

}  // namespace

VelodyneDecoder::VelodyneDecoder(const VelodyneModel& model, const SourceOptions& options, SourceState& state)
    : model_(model), state_(state), builder_(options, kMaxPackets * kBlocks * 2, state.counters) {
  packet_times_ns_.reserve(kMaxPackets);
  for (std::size_t i = 0; i < lasers_.size(); ++i) {
    const double angle = model.lasers[i].vertical_deg * kRadiansPerDegree;
    lasers_[i] = {std::cos(angle), std::sin(angle)};
  }
}

bool VelodyneDecoder::recognises(const Packet& packet) const {
  return packet.size == kPacketSize && load_le<std::uint16_t>(packet.data) == kBlockFlag &&
         load_le<std::uint32_t>(packet.data + 1200) < kHourUs;
}

std::string VelodyneDecoder::expects() const {
  return std::string(model_.name) + ": packets of 1206 bytes that begin with FF EE";
}

std::uint64_t VelodyneDecoder::sensor_id(const Packet& packet) const {
  return packet.data[kPacketSize - 1];
}

double VelodyneDecoder::most_packets_per_s() const {
  return 2e6 / (kBlocks * model_.block_us);  // dual return
}

void VelodyneDecoder::reset() {
  builder_.discard();
  clock_.reset();
  restart_.fits();
  forget();
}

void VelodyneDecoder::forget() {
  open_ = whole_ = false;
  gap_sum_ = 0;
  gap_count_ = received_ = 0;
  packet_times_ns_.clear();
}

bool VelodyneDecoder::decode(const Packet& packet, Sweep& out) {
  check_product(packet.data[1205]);
  dual_ = packet.data[1204] == kDualReturn;
  const std::int64_t past_hour_ns = std::int64_t{load_le<std::uint32_t>(packet.data + 1200)} * 1000;
  const std::int64_t time_ns = clock_.full_time_ns(past_hour_ns, packet.capture_ns, packet.received_ns);
  check_hour();
  const Place at = place(time_ns);
  if (at == Place::duplicate) ++state_.counters.duplicate_packets;
  if (at == Place::late) ++state_.counters.late_packets;
  if (at == Place::within) ++state_.counters.out_of_order_packets;
  if (at == Place::duplicate || at == Place::late) return false;
  const bool closed = at == Place::jump && open_ && close(out);
  const bool may_cut = at != Place::within && !closed;
  return use(packet, time_ns, may_cut, out) || closed;
}

bool VelodyneDecoder::finish(Sweep& out) {
  return open_ && close(out);
}

VelodyneDecoder::Place VelodyneDecoder::place(std::int64_t time_ns) {
  if (!open_) return Place::next;
  const bool endless = time_ns - start_ns_ > kMaxTurnNs || packet_times_ns_.size() >= kMaxPackets;
  if (std::llabs(time_ns - newest_ns_) > kMaxTurnNs || endless) return Place::jump;
  if (time_ns < start_ns_) return restart_.misfits() ? Place::jump : Place::late;
  if (time_ns > newest_ns_) {
    restart_.fits();
    return Place::next;
  }
  const auto end = packet_times_ns_.end();
  return std::find(packet_times_ns_.begin(), end, time_ns) != end ? Place::duplicate : Place::within;
}

/// With `may_cut`, the sweep is closed where the azimuth passes through 0, at most once in a packet.
bool VelodyneDecoder::use(const Packet& packet, std::int64_t time_ns, bool may_cut, Sweep& out) {
  bool closed = false;
  const int count = read_shots(packet.data, time_ns);
  if (count == 0) return false;
  for (int i = 0; i < count; ++i) {
    const Shot& shot = shots_[static_cast<std::size_t>(i)];
    if (may_cut && open_ && shot.azimuth + kMaxJitter < azimuth_) {
      closed = close(out);
      whole_ = true;
      may_cut = false;
    }
    if (!open_) begin(time_ns);
    add(shot);
    if (time_ns >= newest_ns_) azimuth_ = shot.azimuth;
  }
  newest_ns_ = std::max(newest_ns_, time_ns);
  packet_times_ns_.push_back(time_ns);
  builder_.set_received(packet.received_ns);
  return closed;
}

void VelodyneDecoder::begin(std::int64_t time_ns) {
  open_ = true;
  start_ns_ = newest_ns_ = time_ns;
}

int VelodyneDecoder::read_shots(const std::uint8_t* packet, std::int64_t time_ns) {
  const int step = dual_ ? 2 : 1;
  int count = 0;
  for (int i = 0; i < kBlocks; i += step) {
    const std::uint8_t* block = packet + static_cast<std::size_t>(i) * kBlockSize;
    const std::uint8_t* second = dual_ ? block + kBlockSize : nullptr;
    if (!is_block(block) || (dual_ && !is_block(second))) {
      state_.counters.invalid_columns += static_cast<std::uint64_t>(step);
      continue;
    }
    const double after_us = (i / step) * model_.block_us;
    shots_[static_cast<std::size_t>(count++)] = {block, second, time_ns + to_ns(after_us),
                                                 load_le<std::uint16_t>(block + 2), 0};
  }
  fill_gaps(count);
  return count;
}

/// The azimuth turns steadily from block to block; where a gap is not that of a turning sensor (a block is
/// missing, the field of view ends), the gap before stands in for it.
void VelodyneDecoder::fill_gaps(int count) {
  const int max_gap = static_cast<int>(kMaxTurnsPerSecond * kTurn * model_.block_us * 1e-6);
  for (int i = 0; i < count; ++i) {
    Shot& shot = shots_[static_cast<std::size_t>(i)];
    if (i + 1 < count) {
      const int gap = (shots_[static_cast<std::size_t>(i + 1)].azimuth - shot.azimuth + kTurn) % kTurn;
      if (gap <= max_gap) {
        last_gap_ = gap;
        gap_sum_ += gap;
        ++gap_count_;
      }
    }
    shot.gap = last_gap_;
  }
}

void VelodyneDecoder::add(const Shot& shot) {
  ++received_;
  for (int firing = 0; firing < model_.firings_per_block; ++firing) {
    const std::uint32_t index = builder_.add_time(shot.time_ns + to_ns(firing * model_.firing_us));
    builder_.append(scratch_.data(), project(shot, shot.first, firing, index));
    if (shot.second != nullptr) builder_.append(scratch_.data(), project(shot, shot.second, firing, index));
  }
}

/// The returns of one firing sequence; of a second block, only those that differ from the first's.
std::size_t VelodyneDecoder::project(const Shot& shot, const std::uint8_t* block, int firing,
                                     std::uint32_t time_index) {
  const std::size_t lasers = 32 / static_cast<std::size_t>(model_.firings_per_block);
  const std::size_t begin = static_cast<std::size_t>(firing) * lasers;
  std::size_t count = 0;
  for (std::size_t i = begin; i < begin + lasers; ++i) {
    const std::size_t at = 4 + 3 * i;
    const std::uint16_t range = load_le<std::uint16_t>(block + at);
    if (range == 0) continue;
    if (block == shot.second && range == load_le<std::uint16_t>(shot.first + at)) continue;
    const VelodyneLaser& laser = model_.lasers[i];
    const double turned_deg = (shot.azimuth + shot.gap * (laser.firing_us / model_.block_us)) * 0.01;
    const double azimuth = (turned_deg + laser.azimuth_deg) * kRadiansPerDegree;
    const double range_m = range * model_.range_unit_m;
    const double level_m = range_m * lasers_[i].cos_vertical;
    scratch_[count++] = {level_m * std::cos(azimuth), -level_m * std::sin(azimuth),
                         range_m * lasers_[i].sin_vertical, time_index};
  }
  return count;
}

/// A turn has as many blocks as the mean azimuth gap says; less than half a packet missing is a whole turn.
bool VelodyneDecoder::close(Sweep& out) {
  const double expected =
      gap_sum_ > 0 ? static_cast<double>(kTurn) * gap_count_ / static_cast<double>(gap_sum_) : kTurn;
  const double missing = expected - received_;
  const double packet = kBlocks / (dual_ ? 2.0 : 1.0);
  const bool complete = missing < packet / 2;
  state_.counters.columns += static_cast<std::uint64_t>(received_);
  if (whole_ && !complete) state_.counters.missing_columns += static_cast<std::uint64_t>(missing);
  const bool kept = builder_.close(received_ / expected, complete, out);
  forget();
  return kept;
}

void VelodyneDecoder::check_product(std::uint8_t product_id) {
  if (product_checked_) return;
  product_checked_ = true;
  if (product_id == model_.product_id) return;
  char text[160];
  std::snprintf(text, sizeof text, "the packets' model byte is 0x%02X, that of a %s is 0x%02X; decoded as %s",
                product_id, std::string(model_.name).c_str(), model_.product_id,
                std::string(model_.name).c_str());
  state_.warnings.emplace_back(text);
}

void VelodyneDecoder::check_hour() {
  if (hour_checked_ || !clock_.is_hour_unknown()) return;
  hour_checked_ = true;
  state_.warnings.emplace_back(
      "the sensor counts within the hour, and nothing has told the hour yet: stamps start at 0");
}

}  // namespace gvom::ingest
