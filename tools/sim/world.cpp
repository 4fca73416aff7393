#include "tools/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/sim/materials.hpp"
#include "tools/sim/noise.hpp"

namespace gvom::sim {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kAboveWater = 1e-3;  // metres: where a mirrored ray begins

// Streams of a ray's key beside those of the bodies, which are numbered from 0, walkers' from 2^31.
constexpr std::uint64_t kWalkerStream = 1ULL << 31;
constexpr std::uint64_t kRainStream = (1ULL << 32) + 16;
constexpr std::uint64_t kMirrorStream = kRainStream + 1;

const Hit kNothing{kNever, 1.0, 0};

/// That of the ground in patches of half a metre: more dark ones than bright ones.
std::uint8_t soil_reflectivity(double x_m, double y_m) {
  const auto patch = [](double value_m) { return static_cast<std::uint64_t>(std::llround(2.0 * value_m)); };
  const double brightness = uniform(derive(mix(patch(x_m)), patch(y_m)));
  return static_cast<std::uint8_t>(kDarkSoil + (kBrightSoil - kDarkSoil) * brightness * brightness);
}

/// How far a ray goes in what ends `hits_per_m` rays a metre.
double free_path_m(std::uint64_t bits, double hits_per_m) {
  return -std::log(1.0 - uniform(bits)) / hits_per_m;
}

bool misses_box(const Primitive& body, const Ray& ray, const Eigen::Vector3d& inverse, double limit_m) {
  const Eigen::Array3d first = (body.lower - ray.origin).array() * inverse.array();
  const Eigen::Array3d second = (body.upper - ray.origin).array() * inverse.array();
  const double enter = first.min(second).maxCoeff();
  const double leave = first.max(second).minCoeff();
  return enter > leave || leave < 0.0 || enter > limit_m;
}

/// Of a unit vector's components, those of nearly 0 away from it.
Eigen::Vector3d inverse_of(const Eigen::Vector3d& direction) {
  return direction.unaryExpr([](double v) { return 1.0 / (std::abs(v) < 1e-12 ? 1e-12 : v); });
}

std::vector<Primitive> standing_bodies(const WorldData& data) {
  std::vector<Primitive> bodies;
  for (std::size_t i = 0; i < data.objects.size(); ++i) {
    if (data.objects[i].kind == Kind::walker) continue;
    for (const Body& body : data.objects[i].bodies) bodies.emplace_back(body, static_cast<int>(i));
  }
  return bodies;
}

}  // namespace

TrackPoint place_on(const std::vector<TrackPoint>& track, double time_s) {
  const auto after =
      std::find_if(track.begin(), track.end(), [&](const TrackPoint& p) { return p.time_s > time_s; });
  if (after == track.begin()) return track.front();
  if (after == track.end()) return track.back();
  const TrackPoint& before = *(after - 1);
  const double part = (time_s - before.time_s) / (after->time_s - before.time_s);
  return {time_s, before.x_m + part * (after->x_m - before.x_m),
          before.y_m + part * (after->y_m - before.y_m)};
}

World::World(WorldData data)
    : data_(std::move(data)),
      terrain_(data_.ground),
      primitives_(standing_bodies(data_)),
      bins_(primitives_) {}

std::vector<Primitive> World::walkers_at(double time_s) const {
  std::vector<Primitive> bodies;
  for (std::size_t i = 0; i < data_.objects.size(); ++i) {
    const Object& object = data_.objects[i];
    if (object.kind != Kind::walker || object.track.empty()) continue;
    const TrackPoint at = place_on(object.track, time_s);
    const Eigen::Vector3d foot(at.x_m, at.y_m, terrain_.height_m(at.x_m, at.y_m));
    for (Body body : object.bodies) {
      body.centre += foot;
      bodies.emplace_back(body, static_cast<int>(i));
    }
  }
  return bodies;
}

Hit World::cast(const Ray& ray, const std::vector<Primitive>& walkers, double max_range_m,
                std::uint64_t key) const {
  Leg leg = cast_straight(ray, walkers, max_range_m, key);
  if (leg.is_mirrored) {
    const double way_m = leg.hit.range_m;
    const Eigen::Vector3d water = ray.origin + way_m * ray.direction;
    const Ray up{water + Eigen::Vector3d(0.0, 0.0, kAboveWater),
                 {ray.direction.x(), ray.direction.y(), std::abs(ray.direction.z())}};
    leg = cast_straight(up, walkers, max_range_m - way_m, derive(key, kMirrorStream));
    if (leg.is_mirrored) leg.hit = kNothing;
    leg.hit.range_m += way_m;
  }
  if (data_.rain_hits_per_m > 0.0) {
    const double drop_m = free_path_m(derive(key, kRainStream), data_.rain_hits_per_m);
    if (drop_m < std::min(leg.hit.range_m, max_range_m)) return {drop_m, 1.0, kHaze};
  }
  return leg.hit;
}

World::Leg World::cast_straight(const Ray& ray, const std::vector<Primitive>& walkers, double max_range_m,
                                std::uint64_t key) const {
  const double ground_m = terrain_.intersect(ray, max_range_m);
  const Hit body = meet_bodies(ray, walkers, std::min(ground_m, max_range_m), key);
  if (body.range_m < kNever || ground_m == kNever) return {body, false};
  const Eigen::Vector3d point = ray.origin + ground_m * ray.direction;
  const Surface surface = terrain_.surface_at(point.x(), point.y());
  if (surface == Surface::dark) return {kNothing, false};
  const double cosine = std::abs(terrain_.normal_at(point.x(), point.y()).dot(ray.direction));
  return {{ground_m, cosine, soil_reflectivity(point.x(), point.y())}, surface == Surface::mirror};
}

/// The nearest body before `limit_m`.
Hit World::meet_bodies(const Ray& ray, const std::vector<Primitive>& walkers, double limit_m,
                       std::uint64_t key) const {
  const Eigen::Vector3d inverse = inverse_of(ray.direction);
  Hit hit = kNothing;
  const Primitive* solid = nullptr;
  const auto meet = [&](const Primitive& body, std::uint64_t number) {
    if (misses_box(body, ray, inverse, limit_m)) return;
    const Interval inside = intersect(body, ray);
    if (inside.empty() || inside.leave < 0.0 || inside.enter >= limit_m) return;
    double at = std::max(inside.enter, 0.0);
    if (!body.is_solid()) {
      at += free_path_m(derive(key, number), body.body.hits_per_m);
      if (at > inside.leave) return;
    }
    if (at >= limit_m) return;
    limit_m = at;
    hit = {at, 1.0, body.body.reflectivity};
    solid = body.is_solid() ? &body : nullptr;
  };
  bins_.walk(ray, limit_m,
             [&](int number) { meet(primitives_[number], static_cast<std::uint64_t>(number)); });
  for (std::size_t i = 0; i < walkers.size(); ++i) meet(walkers[i], kWalkerStream + i);
  if (solid != nullptr)
    hit.cos_incidence = cos_incidence(*solid, ray.origin + hit.range_m * ray.direction, ray.direction);
  return hit;
}

}  // namespace gvom::sim
