#include "tools/sim/object_reader.hpp"

#include <algorithm>
#include <cmath>

#include "tools/sim/materials.hpp"
#include "tools/sim/primitives.hpp"
#include "tools/sim/world_words.hpp"

namespace gvom::sim {
namespace {

constexpr Bounds kPlace{-1e5, 1e5};
constexpr Bounds kSize{1e-3, 1e3};
constexpr Bounds kAngle{-10.0, 10.0};
constexpr double kSolid = std::numeric_limits<double>::infinity();
constexpr double kBuried = 0.5;  // metres of a trunk below its foot, so that it stands on a slope

Kind read_kind(const JsonKeys& keys) {
  const std::string word = keys.word("kind");
  std::string known;
  for (std::size_t i = 0; i < kKindWords.size(); ++i) {
    if (word == kKindWords[i]) return static_cast<Kind>(i);
    known += (i == 0 ? "" : ", ") + std::string(kKindWords[i]);
  }
  if (keys.has("kind")) keys.complain("\"kind\": " + word + " is none of " + known);
  return Kind::rock;
}

std::uint8_t usual_reflectivity(Kind kind, bool is_solid) {
  switch (kind) {
    case Kind::tree:
    case Kind::branch:
      return is_solid ? kBark : kLeaves;
    case Kind::bush:
    case Kind::grass:
      return kLeaves;
    case Kind::rock:
      return kStone;
    case Kind::wall:
      return kMasonry;
    case Kind::car:
      return kPaint;
    case Kind::walker:
      return kCloth;
    case Kind::dust:
      return kHaze;
  }
  return kStone;
}

Eigen::Vector3d positive(const JsonKeys& keys, const char* key) {
  const Eigen::Vector3d size = keys.point(key, 3);
  if (size.minCoeff() < kSize.low || size.maxCoeff() > kSize.high)
    keys.complain(std::string("\"") + key + "\": expected lengths of 0.001 .. 1000 m");
  return size;
}

/// (x, y), `above_m` above the ground there.
Eigen::Vector3d on_ground(const JsonKeys& keys, const Terrain& terrain, double otherwise_above_m) {
  const double x = keys.number("x_m", kPlace), y = keys.number("y_m", kPlace);
  return {x, y, terrain.height_m(x, y) + keys.number_or("above_m", kPlace, otherwise_above_m)};
}

void read_capsule(const JsonKeys& keys, Body& body) {
  keys.allow_only({"kind", "shape", "from_m", "to_m", "along_m", "radius_m", "hits_per_m", "reflectivity"});
  body.shape = Body::Shape::capsule;
  body.centre = keys.point("from_m", 3);
  if (keys.has("along_m") && keys.has("to_m")) keys.complain("\"to_m\" or \"along_m\", not both");
  body.size = keys.has("along_m") ? Eigen::Vector3d(keys.point("along_m", 3))
                                  : Eigen::Vector3d(keys.point("to_m", 3) - body.centre);
  body.radius_m = keys.number("radius_m", kSize);
}

void read_ellipsoid(const JsonKeys& keys, Body& body) {
  keys.allow_only({"kind", "shape", "centre_m", "radii_m", "yaw_rad", "hits_per_m", "reflectivity"});
  body.shape = Body::Shape::ellipsoid;
  body.centre = keys.point("centre_m", 3);
  body.size = positive(keys, "radii_m");
}

void read_box(const JsonKeys& keys, Body& body) {
  keys.allow_only({"kind", "shape", "centre_m", "half_edges_m", "yaw_rad", "hits_per_m", "reflectivity"});
  body.shape = Body::Shape::box;
  body.centre = keys.point("centre_m", 3);
  body.size = positive(keys, "half_edges_m");
}

/// An upright capsule that goes a little into the ground.
void read_trunk(const JsonKeys& keys, const Terrain& terrain, Body& body) {
  keys.allow_only(
      {"kind", "shape", "x_m", "y_m", "above_m", "radius_m", "height_m", "hits_per_m", "reflectivity"});
  body.shape = Body::Shape::capsule;
  body.centre = on_ground(keys, terrain, -kBuried);
  body.radius_m = keys.number("radius_m", kSize);
  const double length =
      keys.number("height_m", kSize) + (keys.has("above_m") ? 0.0 : kBuried) - body.radius_m;
  body.size = {0.0, 0.0, std::max(length, 0.0)};
}

/// Its middle `above_m` above the ground: half buried where that is not given.
void read_sphere(const JsonKeys& keys, const Terrain& terrain, Body& body) {
  keys.allow_only({"kind", "shape", "x_m", "y_m", "above_m", "radius_m", "hits_per_m", "reflectivity"});
  body.shape = Body::Shape::ellipsoid;
  body.centre = on_ground(keys, terrain, 0.0);
  body.size.setConstant(keys.number("radius_m", kSize));
}

/// Its lower side `above_m` above the ground at its middle.
void read_block(const JsonKeys& keys, const Terrain& terrain, Body& body) {
  keys.allow_only({"kind", "shape", "x_m", "y_m", "above_m", "length_m", "width_m", "height_m", "yaw_rad",
                   "hits_per_m", "reflectivity"});
  body.shape = Body::Shape::box;
  body.size = 0.5 * Eigen::Vector3d(keys.number("length_m", kSize), keys.number("width_m", kSize),
                                    keys.number("height_m", kSize));
  body.centre = on_ground(keys, terrain, 0.0) + Eigen::Vector3d(0.0, 0.0, body.size.z());
}

Body read_body(const JsonKeys& keys, Kind kind, const Terrain& terrain) {
  Body body;
  const std::string shape = keys.word("shape");
  if (shape == "capsule") {
    read_capsule(keys, body);
  } else if (shape == "ellipsoid") {
    read_ellipsoid(keys, body);
  } else if (shape == "box") {
    read_box(keys, body);
  } else if (shape == "trunk") {
    read_trunk(keys, terrain, body);
  } else if (shape == "sphere") {
    read_sphere(keys, terrain, body);
  } else if (shape == "block") {
    read_block(keys, terrain, body);
  } else if (keys.has("shape")) {
    keys.complain("\"shape\": " + shape + " is none of capsule, ellipsoid, box, trunk, sphere, block");
  }
  const bool is_short = shape == "trunk" || shape == "sphere" || shape == "block";
  if (kind == Kind::walker && is_short) keys.complain("\"shape\": a walker's are capsule, ellipsoid and box");
  body.yaw_rad = keys.number_or("yaw_rad", kAngle, 0.0);
  body.hits_per_m = keys.number_or("hits_per_m", {1e-6, 1e6}, kSolid);
  const std::uint8_t usual = usual_reflectivity(kind, !keys.has("hits_per_m"));
  body.reflectivity = static_cast<std::uint8_t>(keys.number_or("reflectivity", {0.0, 247.0}, usual));
  return body;
}

void read_track(const JsonKeys& keys, Object& object) {
  for (const auto& entry : keys.list("track_s_m")) {
    const Eigen::VectorXd point = keys.numbers(entry, "track_s_m", 3);
    if (!object.track.empty() && point[0] <= object.track.back().time_s)
      keys.complain("\"track_s_m\": its times must rise");
    object.track.push_back({point[0], point[1], point[2]});
  }
  if (object.track.empty()) keys.complain("\"track_s_m\": expected a list of [seconds, x, y]");
}

/// A person as a capsule, relative to where it stands.
void read_person(const JsonKeys& keys, Object& object) {
  Body body;
  body.shape = Body::Shape::capsule;
  body.radius_m = keys.number_or("radius_m", kSize, 0.25);
  const double height = keys.number_or("height_m", kSize, 1.8);
  body.centre = {0.0, 0.0, body.radius_m};
  body.size = {0.0, 0.0, std::max(height - 2.0 * body.radius_m, 0.0)};
  body.reflectivity = kCloth;
  object.bodies.push_back(body);
  object.radius_m = body.radius_m;
  object.height_m = height;
}

/// Foot, radius and height, as far as they are not given, from the bodies.
void measure(const JsonKeys& keys, const Terrain& terrain, Object& object) {
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(1e9), upper = -lower;
  for (const Body& body : object.bodies) {
    const Primitive whole(body, 0);
    lower = lower.cwiseMin(whole.lower);
    upper = upper.cwiseMax(whole.upper);
  }
  const Primitive first(object.bodies.front(), 0);
  const Eigen::Vector3d middle = 0.5 * (first.lower + first.upper);
  const double ground = terrain.height_m(middle.x(), middle.y());
  object.position_m = keys.point_or("position_m", {middle.x(), middle.y(), ground});
  object.radius_m =
      keys.number_or("radius_m", {0.0, 1e3}, 0.5 * (first.upper - first.lower).head<2>().maxCoeff());
  const double height = (object.kind == Kind::branch ? lower.z() : upper.z()) - ground;
  object.height_m = keys.number_or("height_m", {-1e3, 1e3}, height);
}

}  // namespace

Object read_object(const nlohmann::json& json, const std::string& where, const Terrain& terrain,
                   Complaint& complaint) {
  const JsonKeys keys(json, where, complaint);
  Object object;
  object.kind = read_kind(keys);
  if (object.kind == Kind::walker) read_track(keys, object);
  if (keys.has("shape") && object.kind != Kind::walker) {  // an object that is its only body
    object.bodies.push_back(read_body(keys, object.kind, terrain));
    measure({nlohmann::json::object(), where, complaint}, terrain, object);
    return object;
  }
  keys.allow_only({"kind", "position_m", "radius_m", "height_m", "bodies", "track_s_m"});
  if (object.kind != Kind::walker && keys.has("track_s_m"))
    keys.complain("\"track_s_m\": only a walker has one");
  if (object.kind == Kind::walker && !keys.has("bodies")) {
    read_person(keys, object);
    return object;
  }
  for (const auto& entry : keys.list("bodies")) {
    const std::string body_where = where + "body " + std::to_string(object.bodies.size()) + ": ";
    object.bodies.push_back(read_body({entry, body_where, complaint}, object.kind, terrain));
  }
  if (object.bodies.empty())
    keys.complain("\"bodies\": expected at least one");
  else
    measure(keys, terrain, object);
  return object;
}

}  // namespace gvom::sim
