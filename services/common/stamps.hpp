// Times in text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace gvom::services {

/// Decimal seconds to nanoseconds, exactly (not through double; digits beyond the ninth decimal are rounded
/// half away from zero). Nothing if `text` is not a decimal number or does not fit.
std::optional<std::int64_t> parse_stamp_ns(std::string_view text);

/// The other way, without zeros at the end: "999.9".
std::string stamp_text(std::int64_t stamp_ns);

/// `2011-09-26 13:02:25.594360375` (or with a T, and a Z at the end), taken as UTC, to nanoseconds since
/// 1970. Nothing if `text` is not a date between 1970 and 2261.
std::optional<std::int64_t> parse_date_ns(std::string_view text);

struct StampLine {
  std::int64_t stamp_ns = 0;
  int line = 0;  ///< Counted from 1.
};

/// A file of times, one a line, decimal seconds or dates, in the file's order; '#' begins a comment line.
/// Errors are `FILE:LINE: reason` or `FILE: reason`.
tl::expected<std::vector<StampLine>, std::string> read_stamps(const std::string& path);

}  // namespace gvom::services
