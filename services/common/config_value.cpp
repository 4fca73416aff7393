#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <ostream>
#include <sstream>

#include "services/common/config_file.hpp"
#include "services/common/config_table.hpp"
#include "services/common/text_hash.hpp"

namespace gvom::services {

namespace {

std::string number_text(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof(buffer), value).ptr;
  return {buffer, end};
}

std::string found_text(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return node.Tag() == "!" ? "the string '" + node.Scalar() + "'" : "'" + node.Scalar() + "'";
    case YAML::NodeType::Sequence:
      return "a list of " + std::to_string(node.size());
    case YAML::NodeType::Map:
      return "a mapping";
    default:
      return "nothing";
  }
}

/// A plain scalar that is a number of type T and nothing else; YAML's leading '+' is allowed.
template <typename T>
std::optional<T> parse_number(const YAML::Node& node) {
  if (!node.IsScalar() || node.Tag() != "?") return std::nullopt;
  const std::string& text = node.Scalar();
  const char* begin = text.data();
  const char* const end = begin + text.size();
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') ++begin;
  T value{};
  const auto result = std::from_chars(begin, end, value);
  if (result.ec != std::errc{} || result.ptr != end) return std::nullopt;
  return value;
}

bool in_range(const RowInfo& row, double value) {
  const bool above = row.rule == Rule::above_min ? value > row.min : value >= row.min;
  return above && value <= row.max;  // false for NaN
}

bool assign_number(const RowInfo& row, const YAML::Node& node, double& out) {
  const auto value = parse_number<double>(node);
  if (!value || !in_range(row, *value)) return false;
  out = *value;
  return true;
}

bool assign_integer(const RowInfo& row, const YAML::Node& node, int& out) {
  const auto value = parse_number<int>(node);
  if (!value || !in_range(row, *value)) return false;
  if (row.rule == Rule::multiple_of_8 && *value % 8 != 0) return false;
  if (row.rule == Rule::odd && *value % 2 == 0) return false;
  out = *value;
  return true;
}

bool is_one_line(const std::string& text) {
  return std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

bool assign_text(const RowInfo& row, const YAML::Node& node, std::string& out) {
  if (!node.IsScalar()) return false;
  const bool valid = row.rule == Rule::identifier ? is_identifier(node.Scalar()) : is_one_line(node.Scalar());
  if (valid) out = node.Scalar();
  return valid;
}

bool assign_choice(const YAML::Node& node, Backend& out) {
  const auto backend = node.IsScalar() ? backend_of(node.Scalar()) : std::nullopt;
  if (backend) out = *backend;
  return backend.has_value();
}

template <class Words, class Value>
bool assign_word(const Words& words, const YAML::Node& node, Value& out) {
  for (const auto& [word, value] : words) {
    if (!node.IsScalar() || node.Scalar() != word) continue;
    out = value;
    return true;
  }
  return false;
}

bool assign_corner(const RowInfo& row, const YAML::Node& node, const BoxCorner& out) {
  if (!node.IsSequence() || node.size() != 3) return false;
  Eigen::Vector3d corner;
  for (int axis = 0; axis < 3; ++axis) {
    if (!assign_number(row, node[axis], corner[axis])) return false;
  }
  if (!out.box->has_value()) {
    const Eigen::Vector3d unset = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    out.box->emplace(Box{unset, unset});
  }
  (**out.box).*out.corner = corner;
  return true;
}

struct Assign {
  const RowInfo& row;
  const YAML::Node& node;
  bool operator()(double* out) const { return assign_number(row, node, *out); }
  bool operator()(int* out) const { return assign_integer(row, node, *out); }
  bool operator()(std::string* out) const { return assign_text(row, node, *out); }
  bool operator()(Backend* out) const { return assign_choice(node, *out); }
  bool operator()(LidarClock* out) const { return assign_word(kClockWords, node, *out); }
  bool operator()(planner::Steering* out) const { return assign_word(kSteeringWords, node, *out); }
  bool operator()(const BoxCorner& out) const { return assign_corner(row, node, out); }
};

/// Single quotes take every character of one line as it is, but themselves.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    result += c;
    if (c == '\'') result += c;
  }
  return result + "'";
}

template <class Words>
std::string choices(const Words& words) {
  std::string text;
  for (const auto& choice : words) text.append(text.empty() ? "" : ", ").append(choice.first);
  return text;
}

template <class Words, class Value>
std::string word_in(const Words& words, const Value& value) {
  for (const auto& choice : words)
    if (choice.second == value) return std::string(choice.first);
  return {};
}

struct ValueText {
  std::string operator()(const double* value) const { return number_text(*value); }
  std::string operator()(const int* value) const { return std::to_string(*value); }
  std::string operator()(const std::string* value) const { return quoted(*value); }
  std::string operator()(const Backend* value) const { return std::string(word_of(*value)); }
  std::string operator()(const LidarClock* value) const { return word_in(kClockWords, *value); }
  std::string operator()(const planner::Steering* value) const { return word_in(kSteeringWords, *value); }
  std::string operator()(const BoxCorner& value) const {
    if (!value.box->has_value()) return {};
    const Eigen::Vector3d& corner = (**value.box).*value.corner;
    return "[" + number_text(corner.x()) + ", " + number_text(corner.y()) + ", " + number_text(corner.z()) +
           "]";
  }
};

/// "m, 0.01 .. 10: voxel edge", as much of it as there is.
std::string comment(const RowInfo& row) {
  const std::string range = range_text(row);
  std::string text = row.unit;
  if (!text.empty() && !range.empty()) text += ", ";
  text += range;
  if (!text.empty() && *row.meaning != '\0') text += ": ";
  return text + row.meaning;
}

std::string spaces(std::size_t count) {
  return std::string(count, ' ');
}

/// Prints what a key's sections are called, each a level deeper, but for those that it shares with the key
/// before it; returns how many there are.
std::size_t print_sections(const std::string& key, const std::string& before, const std::string& indent,
                           std::ostream& out) {
  std::size_t depth = 0;
  bool shared = true;
  for (std::size_t begin = 0, dot; (dot = key.find('.', begin)) != std::string::npos; begin = dot + 1) {
    shared = shared && before.compare(0, dot + 1, key, 0, dot + 1) == 0;
    if (!shared) out << indent << spaces(2 * depth) << key.substr(begin, dot - begin) << ":\n";
    ++depth;
  }
  return depth;
}

/// Rows of which some share a section, as a YAML mapping.
template <typename Config>
void print_rows(const std::vector<Row<Config>>& rows, Config& config, const std::string& indent,
                std::ostream& out) {
  std::string before;
  for (const Row<Config>& row : rows) {
    const std::string key = row.info.key;
    const std::size_t depth = print_sections(key, before, indent, out);
    before = key;
    const std::string value = value_text(row.field(config));
    out << indent << spaces(2 * depth) << (value.empty() ? "# " : "") << key.substr(key.rfind('.') + 1)
        << ": " << (value.empty() ? "[x, y, z]" : value) << "  # " << comment(row.info) << "\n";
  }
}

template <typename Config>
void print_reference_rows(const std::vector<Row<Config>>& rows, const std::string& prefix,
                          std::ostream& out) {
  Config defaults;
  for (const Row<Config>& row : rows) {
    const std::string value = value_text(row.field(defaults));
    out << "| `" << prefix << row.info.key << "` | "
        << (row.info.required ? "required" : (value.empty() ? "none" : value)) << " | " << row.info.unit
        << " | " << range_text(row.info) << " | " << row.info.meaning << " |\n";
  }
}

}  // namespace

tl::expected<void, std::string> assign(const RowInfo& row, const YAML::Node& node, const Field& field) {
  if (std::visit(Assign{row, node}, field)) return {};
  return tl::make_unexpected("expected " + expected_text(row, field) + ", found " + found_text(node));
}

std::string range_text(const RowInfo& row) {
  const std::string bounds = number_text(row.min) + " .. " + number_text(row.max);
  switch (row.rule) {
    case Rule::range:
    case Rule::corner:
      return bounds;
    case Rule::above_min:
      return "above " + bounds;
    case Rule::multiple_of_8:
      return bounds + ", a multiple of 8";
    case Rule::odd:
      return bounds + ", odd";
    case Rule::identifier:
      return "[a-z0-9_], 1 to 31 characters";
    case Rule::choice:
      return choices(kBackendWords);
    case Rule::clock:
      return choices(kClockWords);
    case Rule::steering:
      return choices(kSteeringWords);
    case Rule::text:
      break;
  }
  return {};
}

std::string expected_text(const RowInfo& row, const Field& field) {
  switch (row.rule) {
    case Rule::identifier:
      return "a name of " + range_text(row);
    case Rule::text:
      return "one line of text";
    case Rule::choice:
    case Rule::clock:
    case Rule::steering:
      return "one of " + range_text(row);
    case Rule::corner:
      return "a list [x, y, z] of numbers in " + range_text(row);
    default:
      return (std::holds_alternative<int*>(field) ? "a whole number in " : "a number in ") + range_text(row);
  }
}

std::string value_text(const Field& field) {
  return std::visit(ValueText{}, field);
}

void print_config(const VehicleConfig& config, std::ostream& out) {
  VehicleConfig copy = config;  // accessors hand out writable fields
  print_rows(vehicle_rows(), copy, "", out);
  out << "lidars:\n";
  for (LidarConfig& lidar : copy.lidars) {
    out << "  '" << lidar.name << "':\n";
    print_rows(lidar_rows(), lidar, "    ", out);
  }
}

std::uint64_t config_hash(const VehicleConfig& config) {
  std::ostringstream text;
  print_config(config, text);
  TextHash hash;
  hash.add(text.str());
  return hash.value();
}

void print_config_reference(std::ostream& out) {
  out << "| key | default | unit | range | meaning |\n| --- | --- | --- | --- | --- |\n";
  print_reference_rows(vehicle_rows(), "", out);
  print_reference_rows(lidar_rows(), "lidars.NAME.", out);
}

}  // namespace gvom::services
