#include "services/odometry/rate.hpp"

#include <charconv>

namespace gvom::odometry {

std::optional<Rate> parse_rate(const std::string& text) {
  if (text == "max") return Rate{1.0, true};
  double factor = 0;
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, factor);
  if (result.ec != std::errc{} || result.ptr != end || !(factor > 0 && factor <= 1000)) return std::nullopt;
  return Rate{factor, false};
}

}  // namespace gvom::odometry
