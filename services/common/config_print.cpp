#include <ostream>
#include <sstream>

#include "services/common/config_file.hpp"
#include "services/common/config_value.hpp"

namespace gvom::services {

namespace {

/// "m, 0.01 .. 10: voxel edge", as much of it as there is.
std::string comment(const RowInfo& row) {
  const std::string range = range_text(row);
  std::string text = row.unit;
  if (!text.empty() && !range.empty()) text += ", ";
  text += range;
  if (!text.empty() && *row.meaning != '\0') text += ": ";
  return text + row.meaning;
}

/// Rows of which some share a section, as a YAML mapping.
template <typename Config>
void print_rows(const std::vector<Row<Config>>& rows, Config& config, const std::string& indent,
                std::ostream& out) {
  std::string section;
  for (const Row<Config>& row : rows) {
    const std::string key = row.info.key;
    const std::size_t dot = key.rfind('.');
    const std::string parent = dot == std::string::npos ? "" : key.substr(0, dot);
    if (parent != section && !parent.empty()) out << indent << parent << ":\n";
    section = parent;
    const std::string value = value_text(row.field(config));
    out << indent << (parent.empty() ? "" : "  ") << (value.empty() ? "# " : "") << key.substr(dot + 1)
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
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text.str()) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

void print_config_reference(std::ostream& out) {
  out << "| key | default | unit | range | meaning |\n| --- | --- | --- | --- | --- |\n";
  print_reference_rows(vehicle_rows(), "", out);
  print_reference_rows(lidar_rows(), "lidars.NAME.", out);
}

}  // namespace gvom::services
