#include "tools/sim/truth_files.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tools/common/npy.hpp"
#include "tools/sim/world_words.hpp"

namespace gvom::sim {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kTrackStep = 0.1;  // seconds

Json object_list(const World& world) {
  auto list = Json::array();
  for (const Object& object : world.data().objects)
    list.push_back({{"kind", word_of(object.kind)},
                    {"position_m", {object.position_m.x(), object.position_m.y(), object.position_m.z()}},
                    {"radius_m", object.radius_m},
                    {"height_m", object.height_m}});
  return list;
}

Json walker_track(const Object& walker, double seconds) {
  auto track = Json::array();
  const int points = static_cast<int>(seconds / kTrackStep) + 3;  // past the last sweep
  for (int i = 0; i < points; ++i) {
    const TrackPoint at = place_on(walker.track, i * kTrackStep);
    track.push_back({1e-9 * static_cast<double>(kStartNs) + i * kTrackStep, at.x_m, at.y_m});
  }
  return track;
}

/// `person_xy` is the first walker's track.
void add_walkers(const Scene& scene, Json& json) {
  json["person_xy"] = Json::array();
  json["walkers"] = Json::array();
  const auto& objects = scene.world.data().objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].kind != Kind::walker || objects[i].track.empty()) continue;
    const Json track = walker_track(objects[i], scene.options.seconds);
    if (json["person_xy"].empty()) json["person_xy"] = track;
    json["walkers"].push_back({{"object", i}, {"track_s_m", track}});
  }
}

Json losses_of(const SensorLosses& losses) {
  if (!losses.enabled) return nullptr;
  return {{"reflectivity_percent", losses.reflectivity_percent},
          {"half_seen_m", losses.half_seen_m},
          {"grazing_incidence", losses.grazing_incidence}};
}

Json describe(const Scene& scene, const GroundTruth& truth) {
  const RecordingOptions& options = scene.options;
  Json json;
  json["scene"] = scene.world.data().name;
  json["resolution_m"] = truth.resolution_m;
  json["origin"] = {truth.origin[0], truth.origin[1]};
  json["size"] = {truth.size_x, truth.size_y};
  json["files"] = {"ground_lowest.npy", "ground_mean.npy", "drop.npy",   "clearance.npy", "class.npy",
                   "object.npy",        "drivable.npy",    "lethal.npy", "vegetation.npy"};
  json["classes"] = {"ground", "tree",  "bush", "rock", "ditch",  "step_face", "overhang",
                     "person", "grass", "wall", "car",  "mirror", "dark"};
  json["seed"] = options.sweep.seed;
  json["sensor"] = name_of(options.sensor);
  json["parameters"] = {{"seconds", options.seconds},
                        {"speed_mps", options.speed_mps},
                        {"rate_hz", options.rate_hz},
                        {"range_noise_m", options.sweep.range_noise_m},
                        {"losses", losses_of(options.sweep.losses)},
                        {"odometry_noise_m", options.odometry_noise.position_m},
                        {"odometry_noise_rad", options.odometry_noise.rotation_rad}};
  json["objects"] = object_list(scene.world);
  add_walkers(scene, json);
  return json;
}

}  // namespace

tl::expected<void, std::string> write_truth(const Scene& scene, const GroundTruth& truth,
                                            const std::string& directory) {
  const std::vector<std::size_t> shape{static_cast<std::size_t>(truth.size_y),
                                       static_cast<std::size_t>(truth.size_x)};
  const auto write = [&](const char* name, const auto& layer) {
    return npy::write_npy(directory + "/" + name + ".npy", shape, layer.data());
  };
  const auto written = write("ground_lowest", truth.ground_lowest)
                           .and_then([&] { return write("ground_mean", truth.ground_mean); })
                           .and_then([&] { return write("drop", truth.drop_m); })
                           .and_then([&] { return write("clearance", truth.clearance); })
                           .and_then([&] { return write("class", truth.classes); })
                           .and_then([&] { return write("object", truth.object); })
                           .and_then([&] { return write("drivable", truth.drivable); })
                           .and_then([&] { return write("lethal", truth.lethal); })
                           .and_then([&] { return write("vegetation", truth.vegetation); });
  if (!written) return written;
  const std::string path = directory + "/truth.json";
  std::ofstream file(path);
  file << describe(scene, truth).dump(1) << "\n";
  file.close();
  if (!file) return tl::unexpected(path + ": cannot be written");
  return {};
}

}  // namespace gvom::sim
