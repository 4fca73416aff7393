#include "services/common/dds/names.hpp"

#include <algorithm>

namespace gvom::dds {
namespace {

using Failed = tl::unexpected<std::string>;

constexpr std::size_t kLongestName = 200;  // rmw's own limit is 255 with what it puts in front

// Not those of <cctype>, which ask the locale.
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// One part between slashes.
bool is_word(std::string_view part) {
  return !part.empty() && is_letter(part.front()) &&
         std::all_of(part.begin(), part.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

/// What is wrong with an absolute name; empty: nothing.
std::string fault_of(std::string_view name) {
  if (name.size() > kLongestName) return "is longer than " + std::to_string(kLongestName) + " characters";
  if (name.empty() || name.front() != '/') return "does not begin with a slash";
  for (std::size_t begin = 1; begin <= name.size();) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    if (!is_word(name.substr(begin, end - begin)))
      return "has a part that is not letters, digits and underscores, a digit not first";
    begin = end + 1;
  }
  if (name.back() == '/') return "ends with a slash";
  return {};
}

Failed refused(std::string_view kind, std::string_view name, const std::string& why) {
  return Failed(std::string(kind) + " '" + std::string(name) + "' " + why);
}

}  // namespace

tl::expected<std::string, std::string> topic_on_wire(std::string_view name) {
  if (const std::string fault = fault_of(name); !fault.empty()) return refused("topic", name, fault);
  return "rt" + std::string(name);
}

tl::expected<std::string, std::string> type_on_wire(std::string_view type) {
  constexpr std::string_view kBetween = "/msg/";
  const std::size_t at = type.find(kBetween);
  if (at == std::string_view::npos || type.size() > kLongestName)
    return refused("type", type, "is not PACKAGE/msg/NAME");
  const std::string_view package = type.substr(0, at);
  const std::string_view name = type.substr(at + kBetween.size());
  if (!is_word(package) || !is_word(name)) return refused("type", type, "is not PACKAGE/msg/NAME");
  return std::string(package) + "::msg::dds_::" + std::string(name) + "_";
}

tl::expected<NodeName, std::string> node_name(std::string_view full) {
  if (const std::string fault = fault_of(full); !fault.empty()) return refused("node", full, fault);
  const std::size_t slash = full.rfind('/');
  return NodeName{slash == 0 ? "/" : std::string(full.substr(0, slash)), std::string(full.substr(slash + 1))};
}

}  // namespace gvom::dds
