#include "tools/sim/world_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "tools/common/npy.hpp"
#include "tools/sim/object_reader.hpp"
#include "tools/sim/primitives.hpp"
#include "tools/sim/world_words.hpp"

namespace gvom::sim {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;
using Done = tl::expected<void, std::string>;

// Together they keep a world below about a gigabyte of memory.
constexpr std::size_t kMostNodes = 64'000'000;
constexpr std::uintmax_t kLongestObjects = 256 << 20;  // bytes of objects.json
constexpr double kMostBins = 2e7;                      // of 3.2 m that bodies cover, all together
constexpr double kBin = 3.2;
constexpr double kMostArea = 1e8;   // square metres
constexpr double kHighest = 1e4;    // metres
constexpr double kBesides = 100.0;  // metres that bodies may reach beyond the ground
constexpr Bounds kResolution{0.01, 10.0};
constexpr Bounds kPlace{-1e5, 1e5};

template <typename T>
Done read_nodes(const std::string& path, std::vector<T>& out, std::vector<std::size_t>& shape) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (!error && size / sizeof(T) > kMostNodes)
    return tl::unexpected(path + ": more than " + std::to_string(kMostNodes) + " nodes");
  const auto array = npy::read_npy(path);
  if (!array) return tl::unexpected(array.error());
  auto values = array->template values<T>();
  if (!values) return tl::unexpected(path + ": " + values.error());
  shape = array->shape;
  out = std::move(*values);
  return {};
}

Done read_heights(const std::string& path, GroundMap& ground) {
  std::vector<std::size_t> shape;
  const auto read = read_nodes(path, ground.height_m, shape);
  if (!read) return read;
  if (shape.size() != 2 || shape[0] < 2 || shape[1] < 2)
    return tl::unexpected(path + ": expected heights [y][x], at least 2 x 2");
  ground.nodes_y = static_cast<int>(shape[0]);
  ground.nodes_x = static_cast<int>(shape[1]);
  const auto bad = std::find_if(ground.height_m.begin(), ground.height_m.end(),
                                [](float h) { return !(std::abs(h) <= kHighest); });
  if (bad == ground.height_m.end()) return {};
  const std::ptrdiff_t at = bad - ground.height_m.begin();
  return tl::unexpected(path + ": the height at [" + std::to_string(at / ground.nodes_x) + "][" +
                        std::to_string(at % ground.nodes_x) + "] is no number within 10000 m");
}

/// All plain ground where there is no such file.
Done read_surface(const std::string& path, GroundMap& ground) {
  ground.surface.assign(ground.height_m.size(), Surface::ground);
  if (!fs::exists(path)) return {};
  std::vector<std::uint8_t> numbers;
  std::vector<std::size_t> shape;
  const auto read = read_nodes(path, numbers, shape);
  if (!read) return read;
  if (shape != std::vector<std::size_t>{static_cast<std::size_t>(ground.nodes_y),
                                        static_cast<std::size_t>(ground.nodes_x)})
    return tl::unexpected(path + ": its shape is not that of ground.npy");
  const auto last = static_cast<std::uint8_t>(Surface::dark);
  if (std::any_of(numbers.begin(), numbers.end(), [&](std::uint8_t n) { return n > last; }))
    return tl::unexpected(path + ": expected 0 ground, 1 hole, 2 face, 3 mirror, 4 dark");
  std::transform(numbers.begin(), numbers.end(), ground.surface.begin(),
                 [](std::uint8_t n) { return static_cast<Surface>(n); });
  return {};
}

tl::expected<json, std::string> read_json(const std::string& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (error) return tl::unexpected(path + ": " + error.message());
  if (size > kLongestObjects) return tl::unexpected(path + ": longer than 256 MB");
  std::ifstream file(path);
  try {
    return json::parse(file);
  } catch (const json::exception& wrong) {
    return tl::unexpected(path + ": not JSON: " + wrong.what());
  }
}

void read_top(const JsonKeys& keys, WorldData& world) {
  keys.allow_only({"name", "resolution_m", "min_x_m", "min_y_m", "path_m", "rain_hits_per_m", "objects"});
  if (keys.has("name")) world.name = keys.word("name");
  GroundMap& ground = world.ground;
  ground.resolution_m = keys.number("resolution_m", kResolution);
  ground.min_x_m = keys.number("min_x_m", kPlace);
  ground.min_y_m = keys.number("min_y_m", kPlace);
  world.rain_hits_per_m = keys.number_or("rain_hits_per_m", {0.0, 10.0}, 0.0);
  for (const json& corner : keys.list("path_m")) world.path_m.emplace_back(keys.numbers(corner, "path_m", 2));
}

void check_path(const JsonKeys& keys, const WorldData& world, const Area& area) {
  double length = 0.0;
  for (std::size_t i = 0; i < world.path_m.size(); ++i) {
    const Eigen::Vector2d& at = world.path_m[i];
    if (at.x() < area.min_x_m || at.x() > area.max_x_m || at.y() < area.min_y_m || at.y() > area.max_y_m)
      keys.complain("\"path_m\": corner " + std::to_string(i) + " lies off the ground");
    if (i > 0) length += (at - world.path_m[i - 1]).norm();
  }
  if (length < 1.0 || length > 1e4) keys.complain("\"path_m\": expected a path of 1 m to 10 km");
}

/// Complains of an object that reaches beyond the ground, and of bodies that are too many and too wide.
void check_bodies(const WorldData& world, const Area& area, const std::string& path, Complaint& complaint) {
  const Eigen::Vector3d low(area.min_x_m - kBesides, area.min_y_m - kBesides, -2.0 * kHighest);
  const Eigen::Vector3d high(area.max_x_m + kBesides, area.max_y_m + kBesides, 2.0 * kHighest);
  double bins = 0.0;
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    if (world.objects[i].kind == Kind::walker) continue;
    for (const Body& body : world.objects[i].bodies) {
      const Primitive whole(body, 0);
      if ((whole.lower - low).minCoeff() < 0.0 || (high - whole.upper).minCoeff() < 0.0)
        complaint.say(path + ": object " + std::to_string(i) + " reaches more than 100 m beyond the ground");
      bins += ((whole.upper - whole.lower).head<2>().array() / kBin + 1.0).prod();
    }
  }
  if (bins > kMostBins) complaint.say(path + ": its objects are too many and too wide");
}

json body_json(const Body& body) {
  const auto vector = [](const Eigen::Vector3d& v) { return json{v.x(), v.y(), v.z()}; };
  json out{{"shape", word_of(body.shape)}, {"reflectivity", body.reflectivity}};
  if (std::isfinite(body.hits_per_m)) out["hits_per_m"] = body.hits_per_m;
  if (body.shape == Body::Shape::capsule) {
    out["from_m"] = vector(body.centre);
    out["along_m"] = vector(body.size);
    out["radius_m"] = body.radius_m;
  } else {
    out["centre_m"] = vector(body.centre);
    out[body.shape == Body::Shape::box ? "half_edges_m" : "radii_m"] = vector(body.size);
    out["yaw_rad"] = body.yaw_rad;
  }
  return out;
}

json object_json(const Object& object) {
  json out{{"kind", word_of(object.kind)}, {"radius_m", object.radius_m}, {"height_m", object.height_m}};
  out["position_m"] = {object.position_m.x(), object.position_m.y(), object.position_m.z()};
  out["bodies"] = json::array();
  for (const Body& body : object.bodies) out["bodies"].push_back(body_json(body));
  for (const TrackPoint& point : object.track)
    out["track_s_m"].push_back({point.time_s, point.x_m, point.y_m});
  return out;
}

json world_json(const WorldData& world) {
  json out{{"name", world.name},
           {"resolution_m", world.ground.resolution_m},
           {"min_x_m", world.ground.min_x_m},
           {"min_y_m", world.ground.min_y_m},
           {"rain_hits_per_m", world.rain_hits_per_m},
           {"objects", json::array()},
           {"path_m", json::array()}};
  for (const Object& object : world.objects) out["objects"].push_back(object_json(object));
  for (const Eigen::Vector2d& corner : world.path_m) out["path_m"].push_back({corner.x(), corner.y()});
  return out;
}

}  // namespace

tl::expected<WorldData, std::string> read_world(const std::string& directory) {
  WorldData world;
  world.name = fs::path(directory).filename().string();
  const auto read = read_heights(directory + "/ground.npy", world.ground).and_then([&] {
    return read_surface(directory + "/surface.npy", world.ground);
  });
  if (!read) return tl::unexpected(read.error());
  const std::string path = directory + "/objects.json";
  const auto parsed = read_json(path);
  if (!parsed) return tl::unexpected(parsed.error());

  Complaint complaint;
  const JsonKeys keys(*parsed, path + ": ", complaint);
  read_top(keys, world);
  if (!complaint.text.empty()) return tl::unexpected(complaint.text);
  const Terrain terrain(world.ground);
  const Area area = terrain.area();
  if ((area.max_x_m - area.min_x_m) * (area.max_y_m - area.min_y_m) > kMostArea)
    return tl::unexpected(path + ": a ground of more than 100 square kilometres");
  check_path(keys, world, area);
  if (keys.has("objects"))
    for (const json& object : keys.list("objects")) {
      const std::string where = path + ": object " + std::to_string(world.objects.size()) + ": ";
      world.objects.push_back(read_object(object, where, terrain, complaint));
    }
  if (complaint.text.empty()) check_bodies(world, area, path, complaint);
  if (!complaint.text.empty()) return tl::unexpected(complaint.text);
  return world;
}

Done save_world(const WorldData& world, const std::string& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) return tl::unexpected(directory + ": " + error.message());
  const std::vector<std::size_t> shape{static_cast<std::size_t>(world.ground.nodes_y),
                                       static_cast<std::size_t>(world.ground.nodes_x)};
  auto written = npy::write_npy(directory + "/ground.npy", shape, world.ground.height_m.data());
  const std::vector<Surface>& surface = world.ground.surface;
  const auto* numbers = reinterpret_cast<const std::uint8_t*>(surface.data());
  if (surface.empty()) fs::remove(directory + "/surface.npy", error);
  if (written && !surface.empty()) written = npy::write_npy(directory + "/surface.npy", shape, numbers);
  if (!written) return written;
  const std::string path = directory + "/objects.json";
  std::ofstream file(path);
  file << world_json(world).dump(1) << "\n";
  file.close();
  if (!file) return tl::unexpected(path + ": cannot be written");
  return {};
}

}  // namespace gvom::sim
