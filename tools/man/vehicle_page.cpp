// Prints vehicle.yaml(5), the manual page of the vehicle's file, from the table of its keys.
#include <cstdio>
#include <string>

#include "services/common/config_concerns.hpp"
#include "services/common/config_table.hpp"

namespace {

using namespace gvom::services;

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\e";
    else if (c == '-' || (result.empty() && (c == '.' || c == '\'')))
      result += c == '-' ? "\\-" : std::string("\\&") + c;
    else
      result += c;
  }
  return result;
}

template <typename Config>
void print_rows(const std::vector<Row<Config>>& rows, const std::string& prefix) {
  Config defaults;
  for (const Row<Config>& row : rows) {
    const std::string key = prefix + row.info.key;
    const std::string value = value_text(row.field(defaults));
    std::string facts = range_text(row.info);
    if (*row.info.unit != '\0') facts += (facts.empty() ? "" : " ") + std::string(row.info.unit);
    facts += facts.empty() ? "" : "; ";
    facts += row.info.required ? "required" : "default " + (value.empty() ? "none" : value);
    std::printf(".TP\n.B %s\n%s.\n(%s; a change concerns %s)\n", escaped(key).c_str(),
                escaped(row.info.meaning).c_str(), escaped(facts).c_str(),
                escaped(who_is_concerned(key)).c_str());
  }
}

}  // namespace

int main() {
  std::puts(
      ".TH VEHICLE.YAML 5 \"\" gvom\n.SH NAME\nvehicle.yaml \\- a vehicle and its lidars, for gvom\n.SH "
      "SYNOPSIS\n"
      "/etc/gvom/vehicle.yaml\n.SH DESCRIPTION\nOne YAML mapping. A key is written with dots here: "
      "map.size_xy is "
      "size_xy below map. Unknown keys are refused. All processes of a vehicle read the same file when they "
      "start; "
      "after a change,\n.B gvomctl reload\nrestarts those whom it concerns, and nobody if the file does not "
      "load.\n"
      ".SH KEYS");
  print_rows(vehicle_rows(), "");
  print_rows(lidar_rows(), "lidars.NAME.");
  std::puts(
      ".SH EXAMPLES\n/usr/share/gvom/vehicles; the whole of a file with its defaults:\n.B gvom\\-roudi "
      "\\-\\-config "
      "FILE \\-\\-print\\-config\n.SH SEE ALSO\n.BR gvom (7),\n.BR gvomctl (1)");
}
