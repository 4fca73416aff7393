// Every scene is what its name says, and its path can be driven.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include <catch2/catch.hpp>

#include "tests/tools/scene_probe.hpp"

using namespace gvom::sim;
using gvom::test::Fingerprint;
using gvom::test::ScenePath;

namespace {

const WorldData& scene(const std::string& name) {
  static std::map<std::string, WorldData> built;
  const auto known = built.find(name);
  if (known != built.end()) return known->second;
  return built.emplace(name, build_scene(name, {}).value()).first->second;
}

/// Heights that a straight drive along y = 0 finds at its nodes, from x = 0 on.
std::vector<float> heights_ahead(const WorldData& world, std::vector<Surface>& surface) {
  const GroundMap& ground = world.ground;
  const auto row = static_cast<int>(std::lround(-ground.min_y_m / ground.resolution_m));
  const auto first = static_cast<int>(std::lround(-ground.min_x_m / ground.resolution_m));
  const std::size_t begin = static_cast<std::size_t>(row) * ground.nodes_x + first;
  const std::size_t end = static_cast<std::size_t>(row + 1) * ground.nodes_x;
  surface.assign(ground.surface.begin() + begin, ground.surface.begin() + end);
  return {ground.height_m.begin() + begin, ground.height_m.begin() + end};
}

/// A ditch, as it is met along the path.
struct Found {
  double edge_m;   ///< Along the path.
  double width_m;  ///< Along the path.
  double depth_m;  ///< Below the rim.
  double rim_m;
};

Found ditch_of(const std::string& name) {
  std::vector<Surface> surface;
  const std::vector<float> height = heights_ahead(scene(name), surface);
  const double node = scene(name).ground.resolution_m;
  const auto begin = std::find(surface.begin(), surface.end(), Surface::hole);
  const auto end = std::find_if(begin, surface.end(), [](Surface at) { return at != Surface::hole; });
  const std::size_t near = begin - surface.begin(), far = end - surface.begin();
  // Both in the middle: the ground may slope.
  const double rim = 0.5 * (height.at(near - 2) + height.at(far + 1));
  const double bottom = 0.5 * (height.at((near + far - 1) / 2) + height.at((near + far) / 2));
  return {node * (static_cast<double>(near) - 0.5), node * static_cast<double>(far - near), rim - bottom,
          rim};
}

int count_of(const WorldData& world, Surface surface) {
  return static_cast<int>(std::count(world.ground.surface.begin(), world.ground.surface.end(), surface));
}

bool is_seeded(const std::string& name) {
  static const std::set<std::string> formulas{"flat",       "ramp-up",    "ramp-down",   "ramp-sharp",
                                              "sidehill",   "crest",      "bank-down",   "bank-up",
                                              "cliff",      "ditch-2m-a", "ditch-2m-b",  "ditch-2m-c",
                                              "ditch-1m-a", "ditch-1m-b", "ditch-1m-c",  "ditch-oblique",
                                              "wall",       "walker",     "ditch-slope", "ditch-slope-down"};
  return formulas.count(name) == 0;
}

}  // namespace

TEST_CASE("every scene builds, reaches 50 m around its path and has its own name and summary") {
  std::set<std::string> names;
  for (const SceneEntry& entry : scene_library()) {
    INFO(entry.name);
    const WorldData& world = scene(entry.name);
    const GroundMap& ground = world.ground;
    CHECK(names.insert(entry.name).second);
    CHECK(std::strlen(entry.summary) > 10);
    CHECK(world.name == entry.name);
    REQUIRE(world.path_m.size() >= 2);
    CHECK(world.path_m.front().norm() < 3.0);
    const std::size_t count = static_cast<std::size_t>(ground.nodes_x) * ground.nodes_y;
    REQUIRE(ground.height_m.size() == count);
    REQUIRE(ground.surface.size() == count);
    const double max_x = ground.min_x_m + (ground.nodes_x - 1) * ground.resolution_m;
    const double max_y = ground.min_y_m + (ground.nodes_y - 1) * ground.resolution_m;
    for (const Eigen::Vector2d& corner : world.path_m) {
      CHECK(corner.x() - ground.min_x_m >= 50.0);
      CHECK(max_x - corner.x() >= 50.0);
      CHECK(corner.y() - ground.min_y_m >= 50.0);
      CHECK(max_y - corner.y() >= 50.0);
    }
  }
}

TEST_CASE("the same seed gives the same bytes, another seed others where anything is drawn") {
  for (const SceneEntry& entry : scene_library()) {
    INFO(entry.name);
    const std::uint64_t first = Fingerprint().of(scene(entry.name));
    SceneParameters parameters;
    CHECK(Fingerprint().of(entry.build(parameters)) == first);
    parameters.seed = 2;
    if (is_seeded(entry.name)) CHECK(Fingerprint().of(entry.build(parameters)) != first);
  }
}

TEST_CASE("nothing solid stands within a metre of the path below two metres") {
  for (const SceneEntry& entry : scene_library()) {
    INFO(entry.name);
    CHECK(ScenePath(scene(entry.name)).first_obstacle() == "");
  }
}

TEST_CASE("the path is nowhere steeper than 27 degrees but at its holes") {
  for (const SceneEntry& entry : scene_library()) {
    INFO(entry.name);
    CHECK(ScenePath(scene(entry.name)).steepest_deg() < 27.0);
  }
}

TEST_CASE("ramps and the crest are rounded with 8 m, but for one that has a sharp edge") {
  constexpr double kNode = 0.1;
  struct Bend {
    double per_m = 0.0;
    double x_m = 0.0;
  };
  const auto sharpest = [](const std::string& name) {
    std::vector<Surface> surface;
    const std::vector<float> height = heights_ahead(scene(name), surface);
    Bend bend;
    for (std::size_t i = 4; i + 4 < height.size(); ++i) {  // over 0.8 m: heights are whole 1/4096 m
      const double bent = std::abs(height[i - 4] - 2.0 * height[i] + height[i + 4]) / (16 * kNode * kNode);
      if (bent > bend.per_m) bend = {bent, kNode * static_cast<double>(i)};
    }
    return bend;
  };
  for (const char* name : {"ramp-up", "ramp-down", "crest"}) {
    INFO(name);
    CHECK(1.0 / sharpest(name).per_m == Approx(8.0).margin(0.2));
  }
  CHECK(sharpest("ramp-sharp").x_m == Approx(15.0).margin(0.11));
  CHECK(sharpest("ramp-sharp").per_m * 0.4 == Approx(std::tan(15.0 * 3.14159265 / 180.0)).margin(0.04));
}

TEST_CASE("hills are steep, and can be driven everywhere") {
  const double steepest = gvom::test::steepest_deg(scene("hills").ground);
  CHECK(steepest > 21.0);
  CHECK(steepest < 26.0);
}

TEST_CASE("ditches have the width, the depth and the height above a voxel's face that their names say") {
  struct Expected {
    const char* name;
    double width_m, depth_m, phase_m;
  };
  for (const Expected& expected :
       {Expected{"ditch-2m-a", 2.0, 1.0, 0.01}, Expected{"ditch-2m-b", 2.0, 1.0, 0.13},
        Expected{"ditch-2m-c", 2.0, 1.0, 0.33}, Expected{"ditch-1m-a", 1.0, 0.6, 0.01},
        Expected{"ditch-1m-b", 1.0, 0.6, 0.13}, Expected{"ditch-1m-c", 1.0, 0.6, 0.33}}) {
    INFO(expected.name);
    const Found ditch = ditch_of(expected.name);
    CHECK(ditch.edge_m == Approx(scene(expected.name).path_m.back().x() + 3.05));
    CHECK(ditch.width_m == Approx(expected.width_m));
    CHECK(ditch.depth_m == Approx(expected.depth_m).margin(0.001));
    CHECK(ditch.rim_m - 0.4 * std::floor(ditch.rim_m / 0.4) == Approx(expected.phase_m).margin(0.001));
  }
}

TEST_CASE("ditches on slopes, across and in rough ground are as wide and as deep") {
  CHECK(ditch_of("ditch-oblique").width_m == Approx(2.0 / std::cos(35.0 * 3.14159265 / 180.0)).margin(0.11));
  CHECK(ditch_of("ditch-oblique").depth_m == Approx(1.0).margin(0.001));
  for (const char* name : {"ditch-slope", "ditch-slope-down", "ditch-rough"}) {
    INFO(name);
    CHECK(ditch_of(name).width_m == Approx(2.0));
    CHECK(ditch_of(name).depth_m == Approx(1.0).margin(0.02));
  }
  std::vector<Surface> surface;
  const std::vector<float> up = heights_ahead(scene("ditch-slope"), surface);
  CHECK(std::atan2(up[400] - up[0], 40.0) * 180.0 / 3.14159265 == Approx(10.0).margin(0.01));
}

TEST_CASE("banks have a face of 60 to 70 degrees, a cliff falls by 5 m") {
  for (const auto& [name, rise_m] : std::map<std::string, double>{{"bank-down", -1.5}, {"bank-up", 1.5}}) {
    INFO(name);
    std::vector<Surface> surface;
    const std::vector<float> height = heights_ahead(scene(name), surface);
    const auto faces = std::count(surface.begin(), surface.end(), Surface::face);
    CHECK(height.back() - height.front() == Approx(rise_m).margin(0.001));
    CHECK(std::atan(1.5 / (0.1 * static_cast<double>(faces))) * 57.3 > 60.0);
    CHECK(std::atan(1.5 / (0.1 * static_cast<double>(faces))) * 57.3 < 70.0);
    CHECK((count_of(scene(name), Surface::hole) > 0) == (rise_m < 0.0));
  }
  std::vector<Surface> surface;
  const std::vector<float> height = heights_ahead(scene("cliff"), surface);
  CHECK(height.front() - height.back() == Approx(5.0).margin(0.001));
}

TEST_CASE("a hole is at least 0.2 m below the ground around it") {
  for (const SceneEntry& entry : scene_library()) {
    if (std::string(entry.name) == "trail") continue;  // calls the sides of its ditch a hole from 0.1 m on
    INFO(entry.name);
    CHECK(gvom::test::shallowest_hole_m(scene(entry.name).ground) >= 0.2);
  }
}

TEST_CASE("woods have trunks of all sizes, one for 12 to 15 square metres, and a trail of 3 m") {
  for (const char* name : {"forest", "forest-low"}) {
    INFO(name);
    const ScenePath path(scene(name));
    double thinnest = 1.0, thickest = 0.0, nearest = 100.0, lowest_leaf = 100.0;
    int trunks = 0, low_crowns = 0;
    for (const Object& object : scene(name).objects) {
      if (object.kind != Kind::tree) continue;
      CHECK(object.bodies.front().radius_m == object.radius_m);
      const bool beside = object.position_m.x() > 0.0 && object.position_m.x() < 60.0;
      const double away = path.distance_m(object.position_m.head<2>());
      trunks += beside && away < 40.0;
      if (beside) nearest = std::min(nearest, away - object.radius_m);
      thinnest = std::min(thinnest, object.radius_m);
      thickest = std::max(thickest, object.radius_m);
      const double leaf = gvom::test::lowest_leaf_m(object);
      lowest_leaf = std::min(lowest_leaf, leaf);
      low_crowns += leaf < 2.0;
    }
    CHECK(thinnest < 0.06);
    CHECK(thinnest >= 0.05);
    CHECK(thickest > 0.28);
    CHECK(thickest <= 0.3);
    CHECK(nearest >= 1.499);
    const double area = 60.0 * 2.0 * (40.0 - 1.5);
    CHECK(area / trunks > 12.0);
    CHECK(area / trunks < 15.0);
    CHECK(lowest_leaf == Approx(std::string(name) == "forest" ? 2.5 : 1.3).margin(0.05));
    CHECK((low_crowns > 100) == (std::string(name) == "forest-low"));
  }
}

TEST_CASE("things are as high as they say and stand on the ground") {
  for (const SceneEntry& entry : scene_library()) {
    if (std::string(entry.name) == "trail") continue;  // a capsule's cap makes its trunks a little higher
    INFO(entry.name);
    const WorldData& world = scene(entry.name);
    for (const Object& object : world.objects) {
      if (object.kind == Kind::dust || object.kind == Kind::walker) continue;
      const double ground = height_at(world.ground, object.position_m.x(), object.position_m.y());
      REQUIRE(object.position_m.z() == Approx(ground).margin(0.001));
      if (object.kind == Kind::rock || object.kind == Kind::bush || object.kind == Kind::wall ||
          object.kind == Kind::car || object.kind == Kind::tree)
        REQUIRE(gvom::test::top_m(object) - ground == Approx(object.height_m).margin(0.01));
      if (object.kind == Kind::branch)
        REQUIRE(gvom::test::bottom_m(object) - ground == Approx(object.height_m).margin(0.01));
    }
  }
}

TEST_CASE("bushes keep off the path and are as thin as real ones") {
  const ScenePath path(scene("bushes"));
  int bushes = 0;
  for (const Object& object : scene("bushes").objects) {
    if (object.kind != Kind::bush) continue;
    ++bushes;
    for (const Body& body : object.bodies) {
      const double away = path.distance_m(body.centre.head<2>()) - body.size.x();
      REQUIRE(away >= 1.499);
      REQUIRE(body.hits_per_m >= 0.07);
      REQUIRE(body.hits_per_m <= 0.15);
    }
    REQUIRE(object.height_m >= 0.6);
    REQUIRE(object.height_m <= 1.8);
  }
  CHECK(bushes > 200);
}

TEST_CASE("a walker crosses 10 m ahead of a vehicle at any speed") {
  for (const double speed : {3.0, 5.0, 12.0}) {
    const WorldData world = build_scene("walker", {1, 60.0, speed}).value();
    const std::vector<TrackPoint>& track = world.objects.front().track;
    REQUIRE(track.size() == 2);
    const double walked_mps = (track[1].y_m - track[0].y_m) / (track[1].time_s - track[0].time_s);
    CHECK(walked_mps == Approx(1.4));
    const double crossing_s = track[0].time_s - track[0].y_m / walked_mps;
    CHECK(track[0].x_m - speed * crossing_s == Approx(10.0));
  }
}

TEST_CASE("rain ends two to five of a thousand rays within 30 m") {
  const double ended = 1.0 - std::exp(-30.0 * scene("rain").rain_hits_per_m);
  CHECK(ended > 0.002);
  CHECK(ended < 0.005);
}

TEST_CASE("potholes, puddles and dark patches lie on the path too") {
  for (const auto& [name, surface] : std::map<std::string, Surface>{
           {"potholes", Surface::hole}, {"puddles", Surface::mirror}, {"dark", Surface::dark}}) {
    INFO(name);
    CHECK(ScenePath(scene(name)).share_of(surface) > 0.02);
    CHECK(ScenePath(scene(name)).share_of(surface) < 0.3);
  }
}

TEST_CASE("the error of an unknown scene names the nearest ones") {
  CHECK(build_scene("forrest", {}).error() == "scene \"forrest\" is unknown; the nearest: forest");
  CHECK(build_scene("ditch-2m", {}).error() ==
        "scene \"ditch-2m\" is unknown; the nearest: ditch-2m-a, ditch-2m-b, ditch-2m-c");
}
