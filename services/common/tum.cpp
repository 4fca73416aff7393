#include "services/common/tum.hpp"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

namespace gvom::services {

namespace {

constexpr std::size_t kColumns = 8;
constexpr double kNormTolerance = 1e-3;
constexpr int kNanosecondDigits = 9;

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

std::optional<double> parse_finite(const std::string& text) {
  double value = 0;
  const char* const begin = text.c_str() + (text[0] == '+' ? 1 : 0);
  const char* const end = text.c_str() + text.size();
  const auto result = std::from_chars(begin, end, value);
  if (result.ec != std::errc{} || result.ptr != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::vector<std::string> split(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

tl::expected<StampedPose, std::string> parse_pose(const std::vector<std::string>& words) {
  const auto unexpected = [](const std::string& reason) { return tl::make_unexpected(reason); };
  if (words.size() != kColumns) {
    return unexpected("expected 8 columns (t x y z qx qy qz qw), found " + std::to_string(words.size()));
  }
  const auto stamp_ns = parse_stamp_ns(words[0]);
  if (!stamp_ns) return unexpected("expected a time in seconds, found '" + words[0] + "'");
  double value[kColumns];
  for (std::size_t i = 1; i < kColumns; ++i) {
    const auto number = parse_finite(words[i]);
    if (!number) return unexpected("expected a finite number, found '" + words[i] + "'");
    value[i] = *number;
  }
  StampedPose pose;
  pose.stamp_ns = *stamp_ns;
  pose.T_odom_base.translation_m = {value[1], value[2], value[3]};
  pose.T_odom_base.rotation = Eigen::Quaterniond(value[7], value[4], value[5], value[6]);
  const double norm = pose.T_odom_base.rotation.norm();
  if (!(std::abs(norm - 1.0) <= kNormTolerance)) {
    return unexpected("expected a unit quaternion, found one of norm " + std::to_string(norm));
  }
  pose.T_odom_base.rotation.normalize();
  return pose;
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

tl::expected<std::vector<StampedPose>, std::string> read_tum(const std::string& path) {
  errno = 0;
  std::ifstream file(path);
  if (!file) return tl::make_unexpected(path + ": " + std::strerror(errno));
  std::vector<StampedPose> poses;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::vector<std::string> words = split(line);
    if (words.empty() || words[0][0] == '#') continue;
    const std::string where = path + ":" + std::to_string(number) + ": ";
    const auto pose = parse_pose(words);
    if (!pose) return tl::make_unexpected(where + pose.error());
    if (!poses.empty() && pose->stamp_ns <= poses.back().stamp_ns) {
      return tl::make_unexpected(where + "expected time to go on, found " + words[0] +
                                 " which is not after the line before");
    }
    poses.push_back(*pose);
  }
  if (file.bad()) return tl::make_unexpected(path + ": " + std::strerror(errno));
  if (poses.empty()) return tl::make_unexpected(path + ": no pose in it");
  return poses;
}

tl::expected<std::vector<StampedPose>, std::string> read_odometry_source(const std::string& source) {
  constexpr std::string_view kScheme = "tum:";
  if (source.compare(0, kScheme.size(), kScheme) != 0) {
    return tl::make_unexpected("odometry source '" + source + "': expected tum:FILE");
  }
  return read_tum(source.substr(kScheme.size()));
}

}  // namespace gvom::services
