#include "services/ingest/velodyne_calibration.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "services/common/yaml_documents.hpp"

namespace gvom::ingest {
namespace {

constexpr std::size_t kLasers = 64;
constexpr double kDegreesPerRadian = 180.0 / 3.14159265358979323846;

/// A number of a laser: where it goes, in the file's unit, and its bounds.
struct Key {
  const char* name;
  bool required;
  double low, high;
};

constexpr Key kRotation{"rot_correction", true, -6.3, 6.3};
constexpr Key kVertical{"vert_correction", true, -0.8, 0.8};
constexpr Key kRange{"dist_correction", true, -5, 5};
constexpr Key kNearX{"dist_correction_x", false, -5, 5};
constexpr Key kNearY{"dist_correction_y", false, -5, 5};
constexpr Key kUp{"vert_offset_correction", false, -1, 1};
constexpr Key kAside{"horiz_offset_correction", false, -1, 1};

/// Known, and of no use here: intensities, and what the angles say, too.
const std::set<std::string> kOther = {"laser_id",
                                      "laser_ring",
                                      "focal_distance",
                                      "focal_slope",
                                      "min_intensity",
                                      "max_intensity",
                                      "two_pt_correction_available"};

class CalibrationReader {
 public:
  explicit CalibrationReader(std::string path) : path_(std::move(path)) {}

  void read(const YAML::Node& root, VelodyneModel& model) {
    if (!root.IsMap()) return fail(root, "", "expected keys");
    for (const auto& entry : root) {
      const auto key = entry.first.as<std::string>();
      if (key != "lasers" && key != "num_lasers" && key != "distance_resolution")
        return fail(entry.first, key, "unknown");
    }
    if (root["num_lasers"] && number(root, {"num_lasers", true, 1, 1000}) != kLasers)
      return fail(root["num_lasers"], "num_lasers", "expected 64");
    if (root["distance_resolution"])
      model.range_unit_m = number(root, {"distance_resolution", true, 0.0005, 0.01});
    const YAML::Node lasers = root["lasers"];
    if (!lasers || !lasers.IsSequence() || lasers.size() != kLasers)
      return fail(lasers ? lasers : root, "lasers", "expected a list of 64");
    std::array<bool, kLasers> seen{};
    for (const YAML::Node& laser : lasers) read_laser(laser, seen, model);
    check_angles(lasers, model);
  }

  [[nodiscard]] const std::string& error() const { return error_; }
  void fail(const YAML::Mark& mark, const std::string& key, const std::string& reason) {
    if (!error_.empty()) return;
    error_ = path_ + (mark.is_null() ? "" : ":" + std::to_string(mark.line + 1)) + ": " +
             (key.empty() ? "" : key + ": ") + reason;
  }

 private:
  void fail(const YAML::Node& at, const std::string& key, const std::string& reason) {
    fail(at.Mark(), key, reason);
  }

  double number(const YAML::Node& map, const Key& key) {
    const YAML::Node node = map[key.name];
    if (!node && !key.required) return 0;
    if (!node) fail(map, key.name, "missing");
    double value = std::nan("");
    if (node && node.IsScalar()) YAML::convert<double>::decode(node, value);
    if (value >= key.low && value <= key.high) return value;
    std::ostringstream expected;
    expected << "expected a number of " << key.low << " .. " << key.high;
    fail(node ? node : map, key.name, expected.str());
    return 0;
  }

  void read_laser(const YAML::Node& node, std::array<bool, kLasers>& seen, VelodyneModel& model) {
    if (!node.IsMap()) return fail(node, "lasers", "expected keys");
    for (const auto& entry : node) {
      const auto name = entry.first.as<std::string>();
      const auto is = [&](const Key& key) { return name == key.name; };
      const std::array<Key, 7> keys{kRotation, kVertical, kRange, kNearX, kNearY, kUp, kAside};
      if (kOther.count(name) == 0 && std::none_of(keys.begin(), keys.end(), is))
        return fail(entry.first, name, "unknown");
    }
    const double id = number(node, {"laser_id", true, 0, kLasers - 1});
    const auto index = static_cast<std::size_t>(id);
    if (id != static_cast<double>(index))
      return fail(node["laser_id"], "laser_id", "expected a whole number");
    if (seen[index]) return fail(node["laser_id"], "laser_id", std::to_string(index) + " is there twice");
    seen[index] = true;
    VelodyneLaser& laser = model.lasers[index];
    laser.azimuth_deg = -number(node, kRotation) * kDegreesPerRadian;
    laser.vertical_deg = number(node, kVertical) * kDegreesPerRadian;
    VelodyneCorrection& correction = model.corrections[index];
    correction.range_m = number(node, kRange);
    correction.up_m = number(node, kUp);
    correction.aside_m = number(node, kAside);
    const bool near = node[kNearX.name] && node[kNearY.name];
    correction.near_x_m = near ? number(node, kNearX) : correction.range_m;
    correction.near_y_m = near ? number(node, kNearY) : correction.range_m;
    if (!near && (node[kNearX.name] || node[kNearY.name]))
      fail(node, kNearX.name, "needs dist_correction_y, and the other way round");
  }

  void check_angles(const YAML::Node& lasers, const VelodyneModel& model) {
    std::set<double> angles;
    for (const VelodyneLaser& laser : model.lasers) angles.insert(laser.vertical_deg);
    if (angles.size() < kLasers / 2)
      fail(lasers, "vert_correction",
           "only " + std::to_string(angles.size()) + " angles for 64 lasers: not those of a sensor");
  }

  std::string path_;
  std::string error_;
};

}  // namespace

tl::expected<VelodyneModel, std::string> read_velodyne_calibration(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  if (!file || !(text << file.rdbuf())) return tl::unexpected(path + ": cannot read the calibration");
  if (text.str().find("<boost_serialization") != std::string::npos)
    return tl::unexpected(
        path + ": the maker's XML; make YAML of it by gen_calibration.py of ROS's velodyne_pointcloud");
  CalibrationReader reader(path);
  VelodyneModel model = *find_velodyne_model("HDL-64E");
  try {
    if (services::count_yaml_documents(text.str()) != 1)
      return tl::unexpected(path + ": expected one YAML document");
    reader.read(YAML::Load(text.str()), model);
  } catch (const YAML::Exception& error) {
    reader.fail(error.mark, "", "not YAML: " + error.msg);
  }
  if (!reader.error().empty()) return tl::unexpected(reader.error());
  return model;
}

}  // namespace gvom::ingest
