#include "services/ingest/velodyne_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "services/ingest/bytes.hpp"

namespace gvom::ingest {
namespace {

constexpr int kMaxJitter = 100;         // the azimuth of a turning sensor goes back no further than this
constexpr double kTurnsPerSecond = 10;  // as it leaves the factory
constexpr std::int64_t kMaxTurnNs = 500'000'000;  // the slowest turn is 0.2 s
constexpr std::uint32_t kHourUs = 3'600'000'000u;
constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180.0;

std::int64_t to_ns(double microseconds) {
  return std::llround(microseconds * 1e3);
}

/// Dual return mode sends the most: a sequence is two blocks of each bank.
double most_packets(const VelodyneModel& model) {
  const int blocks = 2 * model.banks;
  const int sequences = kVelodyneBlocks / blocks;
  return 1e6 / (sequences * model.sequence_us);
}

}  // namespace

VelodyneDecoder::VelodyneDecoder(VelodyneModel model, const VelodyneMarks& marks,
                                 const SourceOptions& options, SourceState& state)
    : model_(std::move(model)),
      marks_(marks),
      shots_(model_),
      max_packets_(static_cast<std::size_t>(most_packets(model_) * kMaxTurnNs * 1e-9 * 1.1)),
      state_(state),
      builder_(options, max_packets_ * kVelodyneBlocks, state.counters) {
  packet_times_ns_.reserve(max_packets_);
  for (const VelodyneLaser& laser : model_.lasers) {
    const double angle = laser.vertical_deg * kRadiansPerDegree;
    lasers_.push_back({std::cos(angle), std::sin(angle)});
  }
}

bool VelodyneDecoder::recognises(const Packet& packet) const {
  return packet.size == kVelodynePacketSize && marks_.fit(packet.data) &&
         load_le<std::uint32_t>(packet.data + 1200) < kHourUs;
}

std::string VelodyneDecoder::expects() const {
  char byte[32] = "";
  if (marks_.model_byte) std::snprintf(byte, sizeof byte, ", model byte 0x%02X", *marks_.model_byte);
  if (marks_.banks == 2)
    return std::string(model_.name) + ": packets of 1206 bytes of blocks FF EE and FF DD";
  return std::string(model_.name) + ": packets of 1206 bytes that begin with FF EE" + byte;
}

void VelodyneDecoder::name_other(const Packet& packet, KindText& out) const {
  out[0] = '\0';
  if (packet.size == kVelodynePacketSize && !marks_.fit(packet.data)) marks_.name(packet.data, out);
}

std::string VelodyneDecoder::override_advice(const Packet& packet) const {
  const std::string expected = "the source says " + expects();
  if (!marks_.banks_fit(packet.data)) return expected;
  char byte[64];
  std::snprintf(byte, sizeof byte, "model_byte=0x%02X%s", packet.data[kVelodynePacketSize - 1],
                velodyne_returns(packet.data) ? "" : "&returns=single (or dual)");
  return expected + "; if the packets' last bytes are wrong, add to the source: " + byte;
}

std::uint64_t VelodyneDecoder::sensor_id(const Packet& packet) const {
  return packet.data[kVelodynePacketSize - 1];
}

double VelodyneDecoder::most_packets_per_s() const {
  return most_packets(model_);
}

double VelodyneDecoder::least_packets_per_s() const {
  return most_packets(model_) / 2;  // single return
}

std::size_t VelodyneDecoder::most_returns() const {
  const double sequences = 1e6 / model_.sequence_us / kTurnsPerSecond;
  const double per_sequence = 32.0 * model_.banks;
  return static_cast<std::size_t>(std::ceil(sequences) * per_sequence) *
         (dual_ || marks_.returns == VelodyneReturns::dual ? 2 : 1);
}

void VelodyneDecoder::expect_like(const Packet& packet) {
  dual_ = marks_.returns_of(packet.data) == VelodyneReturns::dual;
}

void VelodyneDecoder::reset() {
  builder_.discard();
  clock_.reset();
  restart_.fits();
  forget();
}

void VelodyneDecoder::forget() {
  open_ = whole_ = false;
  shots_.begin_sweep();
  received_ = 0;
  packet_times_ns_.clear();
}

bool VelodyneDecoder::decode(const Packet& packet, Sweep& out) {
  packet_time_ns_.reset();
  dual_ = marks_.returns_of(packet.data) == VelodyneReturns::dual;
  const std::int64_t past_hour_ns = std::int64_t{load_le<std::uint32_t>(packet.data + 1200)} * 1000;
  const std::int64_t time_ns = clock_.full_time_ns(past_hour_ns, packet.capture_ns, packet.received_ns);
  check_hour();
  const Place at = place(time_ns);
  if (at == Place::duplicate) ++state_.counters.duplicate_packets;
  if (at == Place::late) ++state_.counters.late_packets;
  if (at == Place::within) ++state_.counters.out_of_order_packets;
  if (at == Place::duplicate || at == Place::late) return false;
  if (at == Place::next && open_) check_pace(time_ns);
  const bool closed = at == Place::jump && open_ && close(out);
  const bool may_cut = at != Place::within && !closed;
  return use(packet, time_ns, may_cut, out) || closed;
}

bool VelodyneDecoder::finish(Sweep& out) {
  return open_ && close(out);
}

VelodyneDecoder::Place VelodyneDecoder::place(std::int64_t time_ns) {
  if (!open_) return Place::next;
  const bool endless = time_ns - start_ns_ > kMaxTurnNs || packet_times_ns_.size() >= max_packets_;
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
  const auto before = open_ ? std::optional(VelodyneBefore{azimuth_, newest_ns_}) : std::nullopt;
  state_.counters.invalid_columns +=
      static_cast<std::uint64_t>(shots_.read(packet.data, time_ns, dual_, before));
  if (shots_.begin() == shots_.end()) return false;
  for (const VelodyneShot& shot : shots_) {
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
  packet_time_ns_ = newest_time_ns_;
  builder_.set_received(packet);
  return closed;
}

void VelodyneDecoder::begin(std::int64_t time_ns) {
  open_ = true;
  start_ns_ = newest_ns_ = time_ns;
}

/// The blocks of a sequence share its times.
void VelodyneDecoder::add(const VelodyneShot& shot) {
  ++received_;
  for (int firing = 0; firing < model_.firings; ++firing) {
    const std::int64_t time_ns = shot.time_ns + to_ns(firing * model_.firing_us);
    if (builder_.times() == 0 || time_ns != newest_time_ns_) builder_.add_time(time_ns);
    newest_time_ns_ = time_ns;
    const auto index = static_cast<std::uint32_t>(builder_.times() - 1);
    builder_.append(scratch_.data(), project(shot, shot.first, firing, index));
    if (shot.second != nullptr) builder_.append(scratch_.data(), project(shot, shot.second, firing, index));
  }
}

/// The returns of one firing sequence; of a second block, only those that differ from the first's.
std::size_t VelodyneDecoder::project(const VelodyneShot& shot, const std::uint8_t* block, int firing,
                                     std::uint32_t time_index) {
  const std::size_t lasers = 32 / static_cast<std::size_t>(model_.firings);
  const std::size_t begin = static_cast<std::size_t>(firing) * lasers;
  std::size_t count = 0;
  for (std::size_t k = begin; k < begin + lasers; ++k) {
    const std::size_t at = 4 + 3 * k;
    const std::uint16_t range = load_le<std::uint16_t>(block + at);
    if (range == 0) continue;
    if (block == shot.second && range == load_le<std::uint16_t>(shot.first + at)) continue;
    const std::size_t i = static_cast<std::size_t>(shot.bank) * 32 + k;
    const VelodyneLaser& laser = model_.lasers[i];
    const double turned_deg = (shot.azimuth + shot.gap * (laser.firing_us / model_.sequence_us)) * 0.01;
    const double azimuth = (turned_deg + laser.azimuth_deg) * kRadiansPerDegree;
    const double range_m = range * model_.range_unit_m;
    const auto [cos_vertical, sin_vertical] = lasers_[i];
    if (!model_.corrections.empty()) {
      const auto p = corrected_point(model_.corrections[i], range_m, azimuth, cos_vertical, sin_vertical);
      scratch_[count++] = {p.x_m, p.y_m, p.z_m, time_index};
      continue;
    }
    const double level_m = range_m * cos_vertical;
    scratch_[count++] = {level_m * std::cos(azimuth), -level_m * std::sin(azimuth), range_m * sin_vertical,
                         time_index};
  }
  return count;
}

/// A turn has as many blocks as the mean azimuth gap says; less than half a packet missing is a whole turn.
bool VelodyneDecoder::close(Sweep& out) {
  const double expected = shots_.sequences_a_turn() * model_.banks;
  const double missing = expected - received_;
  const double packet = shots_.blocks_used(dual_) / (dual_ ? 2.0 : 1.0);
  const bool complete = missing < packet / 2;
  state_.counters.columns += static_cast<std::uint64_t>(received_);
  if (whole_ && !complete) state_.counters.missing_columns += static_cast<std::uint64_t>(missing);
  if (pace_.is_off()) {
    builder_.discard();
    ++state_.counters.misfit_sweeps;
    forget();
    return false;
  }
  const bool kept = builder_.close(received_ / expected, complete, out);
  forget();
  return kept;
}

void VelodyneDecoder::check_pace(std::int64_t time_ns) {
  const double packet_us = shots_.blocks_used(dual_) / (model_.banks * (dual_ ? 2 : 1)) * model_.sequence_us;
  pace_.see(time_ns - newest_ns_, packet_us);
  if (!pace_.is_off() || pace_told_) return;
  pace_told_ = true;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "a packet comes each %.0f us, one of model %s in this return mode each %.0f: of another model, or of "
      "other returns than the source says; nothing is used",
      pace_.seen_us(), std::string(model_.name).c_str(), packet_us);
  state_.warnings.emplace_back(text);
}

void VelodyneDecoder::check_hour() {
  if (hour_checked_ || !clock_.is_hour_unknown()) return;
  hour_checked_ = true;
  state_.warnings.emplace_back(
      "the sensor counts within the hour, and nothing has told the hour yet: stamps start at 0");
}

}  // namespace gvom::ingest
