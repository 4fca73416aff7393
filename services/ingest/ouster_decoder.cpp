#include "services/ingest/ouster_decoder.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "services/ingest/bytes.hpp"
#include "services/ingest/ouster_mode.hpp"

namespace gvom::ingest {
namespace {

constexpr int kMaxFramesAhead = 32;
constexpr int kMaxFramesBehind = 16;
constexpr int kMaxFramesLost = 4;  // a longer gap is silence, not loss
constexpr double kLonger =
    1.5;  // than a turn of the metadata's mode; the next slower one takes twice as long
constexpr double kSteps = 6;
constexpr double kMostFramesPerSecond = 20;
constexpr double kLeastFramesPerSecond = 10;
constexpr std::uint64_t kMaxTimestampNs = std::uint64_t{1} << 62;
constexpr std::uint64_t kMaxRepeatNs = 1'000'000'000;
constexpr std::uint64_t kMostApartNs = 1'000'000'000;  // columns of a packet: a turn takes 0.2 s at most

/// The pixels of one column, with their ranges read by `range_mm`. Pixels without a return leave nothing;
/// the write is unconditional and only the count depends on the range, so that nothing mispredicts.
template <typename RangeMm>
std::size_t project_pixels(const OusterGeometry& geometry, const OusterGeometry::ColumnTransform& transform,
                           std::uint32_t time_index, RangeMm range_mm, Return* out) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < geometry.beams.size(); ++i) {
    const std::uint32_t range = range_mm(i);
    const auto p = geometry.project(transform, geometry.beams[i], range);
    out[count] = {p.x_m, p.y_m, p.z_m, time_index};
    count += range != 0 ? 1 : 0;
  }
  return count;
}

}  // namespace

OusterDecoder::OusterDecoder(OusterMetadata metadata, const SourceOptions& options, SourceState& state)
    : metadata_(std::move(metadata)),
      geometry_(metadata_),
      state_(state),
      builder_(options, static_cast<std::size_t>(metadata_.columns_per_frame), state.counters),
      turns_(metadata_, state.warnings),
      scratch_(2 * metadata_.beams()),
      times_(static_cast<std::size_t>(metadata_.columns_per_packet)),
      fresh_(static_cast<std::size_t>(metadata_.columns_per_frame), ColumnState::outside_window),
      columns_(fresh_) {
  for (int i = 0; i < metadata_.window_columns(); ++i) {
    const int id = (metadata_.window_first + i) % metadata_.columns_per_frame;
    fresh_[static_cast<std::size_t>(id)] = ColumnState::missing;
  }
}

bool OusterDecoder::recognises(const Packet& packet) const {
  KindText why;
  return packet.size == metadata_.packet_size() && !is_of_other_mode(metadata_, packet.data, why);
}

std::string OusterDecoder::expects() const {
  return std::to_string(metadata_.beams()) + " beams, " + std::string(metadata_.layout.name) +
         ": packets of " + std::to_string(metadata_.packet_size()) + " bytes";
}

/// IMU packets of before firmware 3.2 have no header, later ones the types 2 (IMU) and 3 (zones).
bool OusterDecoder::is_side_packet(const Packet& packet) const {
  constexpr std::size_t kImuSize = 48;
  if (packet.size == kImuSize) return true;
  if (metadata_.layout.header == OusterHeader::none || packet.size < metadata_.layout.packet_header)
    return false;
  const std::uint8_t type = packet.data[0];
  return packet.size != metadata_.packet_size() && (type == 2 || type == 3) && is_of_this_sensor(packet);
}

/// A packet or metadata without a serial number proves nothing.
bool OusterDecoder::is_of_this_sensor(const Packet& packet) const {
  const std::uint64_t serial = sensor_id(packet);
  return serial == 0 || metadata_.serial == 0 || serial == metadata_.serial;
}

void OusterDecoder::name_other(const Packet& packet, KindText& out) const {
  out[0] = '\0';
  if (packet.size != metadata_.packet_size()) return;
  if (is_of_other_mode(metadata_, packet.data, out)) return;
  out[0] = '\0';
  if (is_of_this_sensor(packet)) return;
  std::snprintf(out.data(), out.size(), "serial number %llu, the metadata is of %llu",
                static_cast<unsigned long long>(sensor_id(packet)),
                static_cast<unsigned long long>(metadata_.serial));
}

std::string OusterDecoder::override_advice(const Packet& packet) const {
  KindText why;
  if (is_of_other_mode(metadata_, packet.data, why))
    return "fetch the metadata of the mode that the sensor is in";
  return "beam angles are each sensor's own; if the metadata is right for these packets all the same, say so "
         "in "
         "the source: serial=" +
         std::to_string(sensor_id(packet));
}

/// Packets of the newer profiles carry the sensor's serial number.
std::uint64_t OusterDecoder::sensor_id(const Packet& packet) const {
  return metadata_.layout.header == OusterHeader::none ? 0 : ouster_serial(metadata_.layout, packet.data);
}

double OusterDecoder::most_packets_per_s() const {
  return kMostFramesPerSecond * metadata_.columns_per_frame / metadata_.columns_per_packet;
}

/// Packets without a column of the window are not sent.
double OusterDecoder::least_packets_per_s() const {
  return kLeastFramesPerSecond * metadata_.window_columns() / metadata_.columns_per_packet;
}

std::size_t OusterDecoder::most_returns() const {
  const std::size_t per_pixel = metadata_.layout.second != 0 ? 2 : 1;
  return metadata_.beams() * static_cast<std::size_t>(metadata_.window_columns()) * per_pixel;
}

void OusterDecoder::reset() {
  builder_.discard();
  restart_.fits();
  any_frame_ = open_ = false;
}

OusterDecoder::Belongs OusterDecoder::classify(std::uint16_t frame) const {
  if (!any_frame_) return Belongs::next_frame;
  const auto ahead = static_cast<std::int16_t>(static_cast<std::uint16_t>(frame - frame_));
  if (ahead == 0) return open_ ? Belongs::open_frame : Belongs::just_completed;
  if (ahead > 0 && ahead <= kMaxFramesAhead) return Belongs::next_frame;
  if (ahead < 0 && ahead >= -kMaxFramesBehind) return Belongs::closed_frame;
  return Belongs::nowhere;
}

/// Whether its columns are not newer than those of the frame just completed: a flood of copies, which tells
/// nothing of a stream that started again.
bool OusterDecoder::is_repeated(const std::uint8_t* packet) const {
  const auto column =
      read_ouster_column(metadata_.layout, packet + metadata_.layout.packet_header, metadata_.beams());
  return column.timestamp_ns <= static_cast<std::uint64_t>(newest_ns_) &&
         column.timestamp_ns + kMaxRepeatNs >= static_cast<std::uint64_t>(newest_ns_);
}

/// True if the packet starts the stream anew, else it is counted as what it is.
bool OusterDecoder::count_stray(Belongs belongs, const std::uint8_t* packet) {
  if (belongs == Belongs::just_completed && is_repeated(packet)) {
    ++state_.counters.duplicate_packets;
    return false;
  }
  if (restart_.misfits()) return true;
  SourceCounters& counters = state_.counters;
  if (belongs == Belongs::closed_frame) ++counters.late_packets;
  if (belongs == Belongs::just_completed) ++counters.duplicate_packets;
  if (belongs == Belongs::nowhere) ++counters.foreign_packets;
  return false;
}

bool OusterDecoder::decode(const Packet& packet, Sweep& out) {
  packet_time_ns_.reset();
  const auto frame = frame_of(metadata_, packet.data);
  if (!frame) {
    state_.counters.invalid_columns += static_cast<std::uint64_t>(metadata_.columns_per_packet);
    return false;
  }
  const Belongs belongs = classify(*frame);
  const bool fits = belongs == Belongs::open_frame || belongs == Belongs::next_frame;
  if (fits) restart_.fits();
  if (!fits && !count_stray(belongs, packet.data)) return false;
  bool closed = false;
  if (belongs != Belongs::open_frame) {
    const bool follows = fits && any_frame_;
    if (follows) count_skipped_frames(*frame);
    watch_turn(packet.data, *frame, follows);
    closed = open_ && close(out);
    begin(*frame);
    whole_ = follows;
  }
  use(packet);
  if (!closed && received_ == metadata_.window_columns()) return close(out);
  return closed;
}

void OusterDecoder::watch_turn(const std::uint8_t* packet, std::uint16_t frame, bool follows) {
  const OusterTurns::Frame before{highest_, newest_ns_};
  const OusterColumn first =
      read_ouster_column(metadata_.layout, packet + metadata_.layout.packet_header, metadata_.beams());
  turns_.begin(first, follows && open_ ? &before : nullptr,
               follows && frame == static_cast<std::uint16_t>(frame_ + 1));
}

bool OusterDecoder::finish(Sweep& out) {
  return open_ && close(out);
}

void OusterDecoder::begin(std::uint16_t frame) {
  frame_ = frame;
  any_frame_ = open_ = true;
  received_ = 0;
  highest_ = -1;
  newest_ns_ = 0;
  columns_ = fresh_;
}

void OusterDecoder::count_skipped_frames(std::uint16_t frame) {
  const int skipped = static_cast<std::uint16_t>(frame - frame_) - 1;
  if (skipped > kMaxFramesLost) return;
  state_.counters.missing_columns += static_cast<std::uint64_t>(skipped * metadata_.window_columns());
}

bool OusterDecoder::close(Sweep& out) {
  open_ = false;
  const int expected = metadata_.window_columns();
  state_.counters.columns += static_cast<std::uint64_t>(received_);
  if (whole_) state_.counters.missing_columns += static_cast<std::uint64_t>(expected - received_);
  if (!turns_.fit(highest_)) {
    builder_.discard();
    ++state_.counters.misfit_sweeps;
    return false;
  }
  return builder_.close(static_cast<double>(received_) / expected, received_ >= expected, out);
}

bool OusterDecoder::usable(const OusterColumn& column, std::uint64_t middle_ns) const {
  const bool other_frame = metadata_.layout.header == OusterHeader::none && column.frame_id != frame_;
  const std::uint64_t time_ns = column.timestamp_ns;
  const bool near = std::max(time_ns, middle_ns) - std::min(time_ns, middle_ns) < kMostApartNs;
  return column.valid && !other_frame && near && time_ns <= kMaxTimestampNs &&
         column.measurement_id < columns_.size() &&
         columns_[column.measurement_id] != ColumnState::outside_window;
}

void OusterDecoder::use(const Packet& packet) {
  const std::size_t beams = metadata_.beams();
  const std::uint8_t* bytes = packet.data + metadata_.layout.packet_header;
  const std::uint64_t middle_ns = middle_time_ns(metadata_, packet.data, times_);
  bool duplicate = false;
  bool behind = false;
  for (int i = 0; i < metadata_.columns_per_packet; ++i, bytes += metadata_.layout.column_size(beams)) {
    const OusterColumn column = read_ouster_column(metadata_.layout, bytes, beams);
    if (!usable(column, middle_ns)) {
      ++state_.counters.invalid_columns;
    } else if (columns_[column.measurement_id] == ColumnState::received) {
      duplicate = true;
    } else {
      behind = behind || column.measurement_id < highest_;
      use_column(bytes, column);
    }
  }
  if (duplicate) ++state_.counters.duplicate_packets;
  if (behind) ++state_.counters.out_of_order_packets;
  builder_.set_received(packet);
}

void OusterDecoder::use_column(const std::uint8_t* bytes, const OusterColumn& column) {
  columns_[column.measurement_id] = ColumnState::received;
  highest_ = std::max<int>(highest_, column.measurement_id);
  ++received_;
  const auto time_ns = static_cast<std::int64_t>(column.timestamp_ns);
  newest_ns_ = std::max(newest_ns_, time_ns);
  packet_time_ns_ = std::max(packet_time_ns_.value_or(time_ns), time_ns);
  const std::uint32_t index = builder_.add_time(time_ns);
  builder_.append(scratch_.data(),
                  project(bytes + metadata_.layout.column_header, column.measurement_id, index));
}

/// A second return counts where it is another than the first.
std::size_t OusterDecoder::project(const std::uint8_t* pixels, std::uint16_t measurement_id,
                                   std::uint32_t time_index) {
  const auto& transform = geometry_.columns[measurement_id];
  const OusterLayout& layout = metadata_.layout;
  const auto both = [&](auto range_mm) {
    const auto first = [=](std::size_t i) { return range_mm(pixels + layout.pixel * i); };
    const std::size_t count = project_pixels(geometry_, transform, time_index, first, scratch_.data());
    if (layout.second == 0) return count;
    const auto second = [=](std::size_t i) {
      const std::uint32_t range = range_mm(pixels + layout.pixel * i + layout.second);
      return range == first(i) ? 0u : range;
    };
    return count + project_pixels(geometry_, transform, time_index, second, scratch_.data() + count);
  };
  switch (layout.range) {
    case OusterRange::bits20:
      return both([](const std::uint8_t* pixel) { return load_le<std::uint32_t>(pixel) & 0xFFFFFu; });
    case OusterRange::bits19:
      return both([](const std::uint8_t* pixel) { return load_le<std::uint32_t>(pixel) & 0x7FFFFu; });
    case OusterRange::bits15_by_8:
      return both([](const std::uint8_t* pixel) { return (load_le<std::uint16_t>(pixel) & 0x7FFFu) * 8u; });
  }
  return 0;
}

}  // namespace gvom::ingest
