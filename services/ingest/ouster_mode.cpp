#include "services/ingest/ouster_mode.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>

namespace gvom::ingest {
namespace {

constexpr double kEncoderTurn = 90112;
constexpr double kMostOff = 1.4;  // modes differ by factors of 2

struct Columns {
  OusterColumn first, last;
  bool any_in_window = false;
};

bool is_in_window(const OusterMetadata& metadata, int column) {
  const int first = metadata.window_first;
  const int last = metadata.window_last;
  if (first <= last) return column >= first && column <= last;
  return column < metadata.columns_per_frame && (column >= first || column <= last);
}

template <typename Visit>
void for_each_valid(const OusterMetadata& metadata, const std::uint8_t* packet, Visit visit) {
  const std::uint8_t* bytes = packet + metadata.layout.packet_header;
  for (int i = 0; i < metadata.columns_per_packet; ++i) {
    const OusterColumn column = read_ouster_column(metadata.layout, bytes, metadata.beams());
    bytes += metadata.layout.column_size(metadata.beams());
    if (column.valid) visit(column);
  }
}

/// The packet's first and last valid column.
std::optional<Columns> valid_columns(const OusterMetadata& metadata, const std::uint8_t* packet) {
  std::optional<Columns> found;
  for_each_valid(metadata, packet, [&](const OusterColumn& column) {
    if (!found) found = Columns{column, column, false};
    found->last = column;
    found->any_in_window = found->any_in_window || is_in_window(metadata, column.measurement_id);
  });
  return found;
}

bool differs(double a, double b) {
  return a > kMostOff * b || b > kMostOff * a;
}

}  // namespace

bool is_of_other_mode(const OusterMetadata& metadata, const std::uint8_t* packet, KindText& why) {
  const auto found = valid_columns(metadata, packet);
  if (!found) return false;
  const auto& [first, last, any_in_window] = *found;
  const int turn = metadata.columns_per_frame;
  if (std::min(first.measurement_id, last.measurement_id) >= turn) {
    std::snprintf(why.data(), why.size(), "column %d, the metadata has %d a turn", last.measurement_id, turn);
    return true;
  }
  if (!any_in_window) {
    std::snprintf(why.data(), why.size(), "column %d, the metadata's window is %d .. %d",
                  first.measurement_id, metadata.window_first, metadata.window_last);
    return true;
  }
  const int columns = last.measurement_id - first.measurement_id;
  if (columns < 1 || last.timestamp_ns <= first.timestamp_ns) return false;
  if (last.encoder > first.encoder) {  // LEGACY: it tells the angle itself
    const double encoded = columns * kEncoderTurn / (last.encoder - first.encoder);
    std::snprintf(why.data(), why.size(), "%.0f columns a turn, the metadata has %d", encoded, turn);
    return differs(encoded, turn);
  }
  if (metadata.turns_per_s <= 0) return false;
  const double expected_us = 1e6 / (metadata.turns_per_s * turn);
  const double column_us = static_cast<double>(last.timestamp_ns - first.timestamp_ns) * 1e-3 / columns;
  std::snprintf(why.data(), why.size(), "a column each %.0f us, %.0f in the metadata's mode", column_us,
                expected_us);
  return differs(column_us, expected_us);
}

std::optional<std::uint16_t> frame_of(const OusterMetadata& metadata, const std::uint8_t* packet) {
  if (metadata.layout.header != OusterHeader::none) return ouster_frame(metadata.layout, packet);
  // A column that is not valid may hold anything, so the first valid one tells.
  const auto found = valid_columns(metadata, packet);
  return found ? std::optional(found->first.frame_id) : std::nullopt;
}

std::uint64_t middle_time_ns(const OusterMetadata& metadata, const std::uint8_t* packet,
                             std::vector<std::uint64_t>& scratch) {
  scratch.clear();
  for_each_valid(metadata, packet,
                 [&](const OusterColumn& column) { scratch.push_back(column.timestamp_ns); });
  if (scratch.empty()) return 0;
  const auto middle = scratch.begin() + static_cast<std::ptrdiff_t>(scratch.size() / 2);
  std::nth_element(scratch.begin(), middle, scratch.end());
  return *middle;
}

}  // namespace gvom::ingest
