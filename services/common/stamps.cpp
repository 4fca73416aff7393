#include "services/common/stamps.hpp"

#include <charconv>
#include <ctime>
#include <limits>
#include <string>

#include "services/common/line_reader.hpp"

namespace gvom::services {

namespace {

constexpr int kNanosecondDigits = 9;
constexpr std::int64_t kMaxStampNs = 4'000'000'000'000'000'000;  // leaves room to add a time within a sweep

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// A decimal number as its digits without the point, and the power of ten of the last one.
struct Decimal {
  bool negative = false;
  std::string digits;
  int exponent = 0;
};

std::optional<Decimal> parse_decimal(std::string_view text) {
  Decimal result;
  std::size_t i = 0;
  if (i < text.size() && (text[i] == '-' || text[i] == '+')) result.negative = text[i++] == '-';
  bool after_point = false;
  for (; i < text.size() && (is_digit(text[i]) || (text[i] == '.' && !after_point)); ++i) {
    if (text[i] == '.') {
      after_point = true;
    } else {
      result.digits += text[i];
      if (after_point) --result.exponent;
    }
  }
  if (result.digits.empty()) return std::nullopt;
  if (i == text.size()) return result;
  if (text[i] != 'e' && text[i] != 'E') return std::nullopt;
  if (++i < text.size() && text[i] == '+') ++i;
  int exponent = 0;
  const auto parsed = std::from_chars(text.data() + i, text.data() + text.size(), exponent);
  if (parsed.ec != std::errc{} || parsed.ptr != text.data() + text.size()) return std::nullopt;
  if (exponent < -1000 || exponent > 1000) return std::nullopt;
  result.exponent += exponent;
  return result;
}

/// Takes the digits of `text`, as many as `form` has of `d`; every other letter of `form` must be there.
bool take(std::string_view& text, std::string_view form, int& value) {
  value = 0;
  if (text.size() < form.size()) return false;
  for (std::size_t i = 0; i < form.size(); ++i) {
    if (form[i] != 'd' && form[i] != text[i]) return false;
    if (form[i] == 'd' && !is_digit(text[i])) return false;
    if (form[i] == 'd') value = value * 10 + (text[i] - '0');
  }
  text.remove_prefix(form.size());
  return true;
}

/// The seconds since 1970 of a day and hour that are in the calendar.
std::optional<std::int64_t> seconds_of(std::tm date) {
  const std::tm asked = date;
  const std::time_t seconds = ::timegm(&date);
  const bool same = date.tm_year == asked.tm_year && date.tm_mon == asked.tm_mon &&
                    date.tm_mday == asked.tm_mday && date.tm_hour == asked.tm_hour &&
                    date.tm_min == asked.tm_min && date.tm_sec == asked.tm_sec;
  constexpr int kFirstYear = 1970, kLastYear = 2261;
  const int year = asked.tm_year + 1900;
  if (!same || year < kFirstYear || year > kLastYear) return std::nullopt;
  return seconds;
}

}  // namespace

std::optional<std::int64_t> parse_stamp_ns(std::string_view text) {
  const auto decimal = parse_decimal(text);
  if (!decimal) return std::nullopt;
  const int shift = decimal->exponent + kNanosecondDigits;  // of the last digit, in powers of ten of 1 ns
  const int whole = static_cast<int>(decimal->digits.size()) + shift;  // digits of whole nanoseconds
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  std::int64_t value = 0;
  for (int i = 0; i < whole; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const int digit = at < decimal->digits.size() ? decimal->digits[at] - '0' : 0;
    if (value > (kMax - digit) / 10) return std::nullopt;
    value = value * 10 + digit;
  }
  const auto first_cut = static_cast<std::size_t>(whole);
  if (whole >= 0 && first_cut < decimal->digits.size() && decimal->digits[first_cut] >= '5' && value < kMax)
    ++value;
  return decimal->negative ? -value : value;
}

std::string stamp_text(std::int64_t stamp_ns) {
  constexpr std::uint64_t kSecond_ns = 1'000'000'000;
  const auto size =
      stamp_ns < 0 ? -static_cast<std::uint64_t>(stamp_ns) : static_cast<std::uint64_t>(stamp_ns);
  std::string decimals = std::to_string(kSecond_ns + size % kSecond_ns).substr(1);
  decimals.erase(decimals.find_last_not_of('0') + 1);
  return (stamp_ns < 0 ? "-" : "") + std::to_string(size / kSecond_ns) + (decimals.empty() ? "" : ".") +
         decimals;
}

std::optional<std::int64_t> parse_date_ns(std::string_view text) {
  std::tm date{};
  if (!text.empty() && text.back() == 'Z') text.remove_suffix(1);
  if (!take(text, "dddd-", date.tm_year) || !take(text, "dd-", date.tm_mon) ||
      !take(text, "dd", date.tm_mday) || text.empty() || (text[0] != ' ' && text[0] != 'T'))
    return std::nullopt;
  text.remove_prefix(1);
  if (!take(text, "dd:", date.tm_hour) || !take(text, "dd:", date.tm_min) || !take(text, "dd", date.tm_sec))
    return std::nullopt;
  date.tm_year -= 1900;
  date.tm_mon -= 1;
  const auto seconds = seconds_of(date);
  if (!seconds || (!text.empty() && (text[0] != '.' || text.size() == 1))) return std::nullopt;
  const auto fraction_ns = text.empty() ? 0 : parse_stamp_ns(text);
  if (!fraction_ns || text.find_first_of("eE") != std::string_view::npos) return std::nullopt;
  return *seconds * 1'000'000'000 + *fraction_ns;
}

tl::expected<std::vector<StampLine>, std::string> read_stamps(const std::string& path) {
  LineReader lines(path);
  std::vector<StampLine> stamps;
  while (lines.next()) {
    if (lines.text()[0] == '#') continue;
    auto stamp_ns = parse_stamp_ns(lines.text());
    if (!stamp_ns) stamp_ns = parse_date_ns(lines.text());
    if (!stamp_ns || *stamp_ns > kMaxStampNs || *stamp_ns < -kMaxStampNs) {
      return tl::unexpected(lines.where() + "'" + lines.text() +
                            "' is not a time in seconds, nor a date (2011-09-26 13:02:25.5)");
    }
    stamps.push_back({*stamp_ns, lines.number()});
  }
  if (!lines.error().empty()) return tl::unexpected(lines.error());
  return stamps;
}

}  // namespace gvom::services
