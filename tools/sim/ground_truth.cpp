#include "tools/sim/ground_truth.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/grid.hpp"
#include "tools/common/npy.hpp"
#include "tools/sim/parallel.hpp"

namespace gvom::sim {
namespace {

constexpr double kSample = 0.05;      // metres between samples, at most
constexpr double kOverhead = 2.0;     // what begins higher above the ground leaves the column passable
constexpr double kProtrusion = 0.05;  // what sticks out less is ground
constexpr double kDitchRim = 0.1;     // shallower is still the rim
constexpr double kPersonStep = 0.02;  // seconds
constexpr double kTrackStep = 0.1;    // seconds
constexpr float kUnbounded = std::numeric_limits<float>::infinity();

/// What was found in a column so far. A thing that stands in the way outranks one overhead.
struct Column {
  double lowest = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  double depth = 0.0;
  double overhead = std::numeric_limits<double>::infinity();
  int standing_object = -1;
  int overhead_object = -1;
  bool face = false;
};

void sample_bodies(const World& world, double x, double y, double ground, Column& column) {
  const Ray upwards{{x, y, 0.0}, Eigen::Vector3d::UnitZ()};
  world.bins().visit_over(x, y, [&](int number) {
    const Primitive& body = world.primitives()[number];
    const Interval inside = intersect(body, upwards);
    if (inside.empty() || inside.leave < ground + kProtrusion) return;
    if (inside.enter < ground + kOverhead) {
      column.standing_object = body.object;
    } else if (inside.enter < column.overhead) {
      column.overhead = inside.enter;
      column.overhead_object = body.object;
    }
  });
}

Column sample_column(const World& world, double min_x, double min_y, double edge) {
  const int samples = static_cast<int>(std::ceil(edge / kSample));
  Column column;
  for (int i = 0; i < samples * samples; ++i) {
    const double x = min_x + edge * (i % samples + 0.5) / samples;
    const double y = min_y + edge * (i / samples + 0.5) / samples;
    const double ground = world.terrain().height_m(x, y);
    column.lowest = std::min(column.lowest, ground);
    column.sum += ground;
    column.depth = std::max(column.depth, world.landscape().ditch_depth_m(x, y));
    column.face = column.face || world.landscape().on_step_face(x, y);
    sample_bodies(world, x, y, ground, column);
  }
  column.sum /= samples * samples;
  return column;
}

ObjectClass class_of(const World& world, const Column& column) {
  if (column.standing_object >= 0) {
    const std::string& kind = world.objects()[column.standing_object].kind;
    return kind == "bush" ? ObjectClass::bush : kind == "rock" ? ObjectClass::rock : ObjectClass::tree;
  }
  if (column.overhead_object >= 0) return ObjectClass::overhang;
  if (column.face) return ObjectClass::step_face;
  return column.depth > kDitchRim ? ObjectClass::ditch : ObjectClass::ground;
}

/// Marks the columns that the person's body covers at some time of the recording.
void mark_person(const Scene& scene, GroundTruth& truth) {
  for (double time = 0.0; time <= scene.options.seconds; time += kPersonStep) {
    const Primitive person = scene.world.person_at(time);
    for (double dy = -person.radius_m; dy <= person.radius_m; dy += kSample)
      for (double dx = -person.radius_m; dx <= person.radius_m; dx += kSample) {
        if (dx * dx + dy * dy > person.radius_m * person.radius_m) continue;
        const auto index = [&](double value, int axis) {
          return static_cast<std::int64_t>(std::floor(voxel_coordinate(value, truth.resolution_m))) -
                 truth.origin[axis];
        };
        const std::int64_t ix = index(person.centre.x() + dx, 0);
        const std::int64_t iy = index(person.centre.y() + dy, 1);
        if (ix < 0 || iy < 0 || ix >= truth.size_x || iy >= truth.size_y) continue;
        truth.classes[iy * truth.size_x + ix] = static_cast<std::uint8_t>(ObjectClass::person);
        truth.object[iy * truth.size_x + ix] = -1;
      }
  }
}

nlohmann::ordered_json object_list(const World& world) {
  auto list = nlohmann::ordered_json::array();
  for (const Object& object : world.objects())
    list.push_back({{"kind", object.kind},
                    {"position_m", {object.position_m.x(), object.position_m.y(), object.position_m.z()}},
                    {"radius_m", object.radius_m},
                    {"height_m", object.height_m}});
  return list;
}

nlohmann::ordered_json person_track(const Scene& scene) {
  auto track = nlohmann::ordered_json::array();
  const int points = static_cast<int>(scene.options.seconds / kTrackStep) + 3;  // past the last sweep
  for (int i = 0; i < points; ++i) {
    const Primitive person = scene.world.person_at(i * kTrackStep);
    track.push_back(
        {1e-9 * static_cast<double>(kStartNs) + i * kTrackStep, person.centre.x(), person.centre.y()});
  }
  return track;
}

nlohmann::ordered_json describe(const Scene& scene, const GroundTruth& truth) {
  const RecordingOptions& options = scene.options;
  nlohmann::ordered_json json;
  json["resolution_m"] = truth.resolution_m;
  json["origin"] = {truth.origin[0], truth.origin[1]};
  json["size"] = {truth.size_x, truth.size_y};
  json["files"] = {"ground_lowest.npy", "ground_mean.npy", "ditch_depth.npy",
                   "clearance.npy",     "class.npy",       "object.npy"};
  json["classes"] = {"ground", "tree", "bush", "rock", "ditch", "step_face", "overhang", "person"};
  json["seed"] = options.seed;
  json["parameters"] = {{"seconds", options.seconds},
                        {"speed_mps", options.speed_mps},
                        {"rate_hz", options.rate_hz},
                        {"range_noise_m", options.range_noise_m},
                        {"odometry_noise_m", options.odometry_noise.position_m},
                        {"odometry_noise_rad", options.odometry_noise.rotation_rad}};
  json["objects"] = object_list(scene.world);
  json["person_xy"] = person_track(scene);
  return json;
}

}  // namespace

GroundTruth sample_truth(const Scene& scene, double resolution_m) {
  const Area& area = scene.world.truth_area();
  const auto voxel = [&](double value) {
    return static_cast<std::int64_t>(std::floor(voxel_coordinate(value, resolution_m)));
  };
  GroundTruth truth{};
  truth.resolution_m = resolution_m;
  truth.origin[0] = voxel(area.min_x_m);
  truth.origin[1] = voxel(area.min_y_m);
  truth.size_x = static_cast<int>(voxel(area.max_x_m) - truth.origin[0]) + 1;
  truth.size_y = static_cast<int>(voxel(area.max_y_m) - truth.origin[1]) + 1;
  const std::size_t count = static_cast<std::size_t>(truth.size_x) * truth.size_y;
  for (std::vector<float>* layer :
       {&truth.ground_lowest, &truth.ground_mean, &truth.ditch_depth, &truth.clearance})
    layer->resize(count);
  truth.classes.resize(count);
  truth.object.resize(count);

  parallel_for(truth.size_y, scene.options.threads, [&](int iy) {
    for (int ix = 0; ix < truth.size_x; ++ix) {
      const Column column =
          sample_column(scene.world, static_cast<double>(truth.origin[0] + ix) * resolution_m,
                        static_cast<double>(truth.origin[1] + iy) * resolution_m, resolution_m);
      const std::size_t at = static_cast<std::size_t>(iy) * truth.size_x + ix;
      truth.ground_lowest[at] = static_cast<float>(column.lowest);
      truth.ground_mean[at] = static_cast<float>(column.sum);
      truth.ditch_depth[at] = static_cast<float>(column.depth);
      truth.clearance[at] =
          column.overhead_object >= 0 ? static_cast<float>(column.overhead - column.lowest) : kUnbounded;
      truth.classes[at] = static_cast<std::uint8_t>(class_of(scene.world, column));
      truth.object[at] = column.standing_object >= 0 ? column.standing_object : column.overhead_object;
    }
  });
  mark_person(scene, truth);
  return truth;
}

tl::expected<void, std::string> write_truth(const Scene& scene, const GroundTruth& truth,
                                            const std::string& directory) {
  const std::vector<std::size_t> shape{static_cast<std::size_t>(truth.size_y),
                                       static_cast<std::size_t>(truth.size_x)};
  const auto write = [&](const char* name, const auto& layer) {
    return npy::write_npy(directory + "/" + name + ".npy", shape, layer.data());
  };
  const auto written = write("ground_lowest", truth.ground_lowest)
                           .and_then([&] { return write("ground_mean", truth.ground_mean); })
                           .and_then([&] { return write("ditch_depth", truth.ditch_depth); })
                           .and_then([&] { return write("clearance", truth.clearance); })
                           .and_then([&] { return write("class", truth.classes); })
                           .and_then([&] { return write("object", truth.object); });
  if (!written) return written;
  const std::string path = directory + "/truth.json";
  std::ofstream file(path);
  file << describe(scene, truth).dump(1) << "\n";
  file.close();
  if (!file) return tl::unexpected(path + ": cannot be written");
  return {};
}

}  // namespace gvom::sim
