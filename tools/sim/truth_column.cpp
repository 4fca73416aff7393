#include "tools/sim/truth_column.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::sim {
namespace {

constexpr double kSample = 0.05;      // metres between samples, at most
constexpr double kVehicle = 2.0;      // what begins higher above the ground leaves the column passable
constexpr double kProtrusion = 0.05;  // what sticks out less is ground
constexpr double kLow = 0.3;          // what sticks out less is no obstacle
constexpr double kTallRock = 0.5;

/// Of two things in a column the one that ranks higher gives the class; what hangs high ranks lowest.
int rank_of(ObjectClass what) {
  switch (what) {
    case ObjectClass::ground:
      return 0;
    case ObjectClass::dark:
    case ObjectClass::mirror:
      return 2;
    case ObjectClass::grass:
      return 3;
    case ObjectClass::step_face:
      return 4;
    case ObjectClass::ditch:
      return 5;
    case ObjectClass::bush:
      return 6;
    default:
      return 7;
  }
}

void take_class(ObjectClass what, int object, TruthColumn& column) {
  if (rank_of(what) <= rank_of(column.what)) return;
  column.what = what;
  column.object = object;
}

ObjectClass class_of(Surface surface) {
  switch (surface) {
    case Surface::ground:
      return ObjectClass::ground;
    case Surface::hole:
      return ObjectClass::ditch;
    case Surface::face:
      return ObjectClass::step_face;
    case Surface::mirror:
      return ObjectClass::mirror;
    case Surface::dark:
      return ObjectClass::dark;
  }
  return ObjectClass::ground;
}

/// Whether a solid part of the object that is in a vehicle's way would end its drive.
bool is_lethal(const Object& object) {
  switch (object.kind) {
    case Kind::tree:
    case Kind::wall:
    case Kind::car:
    case Kind::branch:
      return true;
    case Kind::rock:
      return object.height_m >= kTallRock;
    default:
      return false;
  }
}

/// What a body is to the ground below it: `from_m` and `to_m` above it.
void add_body(const Primitive& body, const Object& object, double ground_m, double from_m, double to_m,
              TruthColumn& column) {
  const bool is_leaf = !body.is_solid() &&
                       (object.kind == Kind::tree || object.kind == Kind::bush || object.kind == Kind::grass);
  column.is_vegetation = column.is_vegetation || is_leaf;
  const bool is_branch = object.kind == Kind::branch;
  if ((is_branch || from_m >= kVehicle) && ground_m + from_m < column.overhead_m) {
    column.overhead_m = ground_m + from_m;
    column.overhead_object = body.object;
  }
  if (from_m >= kVehicle) return;
  take_class(class_of(object.kind), body.object, column);
  if (object.kind == Kind::grass || to_m < kLow) return;
  column.is_blocked = true;
  column.is_lethal = column.is_lethal || (body.is_solid() && is_lethal(object));
}

/// The highest and lowest are those of the samples.
void add_sample(const World& world, double x_m, double y_m, TruthColumn& column) {
  const double ground_m = world.terrain().height_m(x_m, y_m);
  column.lowest_m = std::min(column.lowest_m, ground_m);
  column.highest_m = std::max(column.highest_m, ground_m);
  column.mean_m += ground_m;
  const Surface surface = world.terrain().surface_at(x_m, y_m);
  column.is_hole = column.is_hole || surface == Surface::hole;
  column.is_face = column.is_face || surface == Surface::face;
  take_class(class_of(surface), -1, column);

  const Ray upwards{{x_m, y_m, ground_m}, Eigen::Vector3d::UnitZ()};
  world.bins().visit_over(x_m, y_m, [&](int number) {
    const Primitive& body = world.primitives()[number];
    const Object& object = world.data().objects[body.object];
    const bool is_beside =
        x_m < body.lower.x() || x_m > body.upper.x() || y_m < body.lower.y() || y_m > body.upper.y();
    if (is_beside || object.kind == Kind::dust) return;
    const Interval inside = intersect(body, upwards);
    if (!inside.empty() && inside.leave >= kProtrusion)
      add_body(body, object, ground_m, inside.enter, inside.leave, column);
  });
}

}  // namespace

ObjectClass class_of(Kind kind) {
  switch (kind) {
    case Kind::tree:
      return ObjectClass::tree;
    case Kind::bush:
      return ObjectClass::bush;
    case Kind::grass:
      return ObjectClass::grass;
    case Kind::rock:
      return ObjectClass::rock;
    case Kind::wall:
      return ObjectClass::wall;
    case Kind::car:
      return ObjectClass::car;
    case Kind::branch:
      return ObjectClass::overhang;
    case Kind::walker:
      return ObjectClass::person;
    case Kind::dust:
      return ObjectClass::ground;
  }
  return ObjectClass::ground;
}

TruthColumn sample_column(const World& world, double min_x_m, double min_y_m, double edge_m) {
  const int samples = static_cast<int>(std::ceil(edge_m / kSample));
  TruthColumn column;
  for (int i = 0; i < samples * samples; ++i)
    add_sample(world, min_x_m + edge_m * (i % samples + 0.5) / samples,
               min_y_m + edge_m * (i / samples + 0.5) / samples, column);
  column.mean_m /= samples * samples;
  if (column.what == ObjectClass::ground && column.overhead_object >= 0) {
    column.what = ObjectClass::overhang;
    column.object = column.overhead_object;
  }
  return column;
}

}  // namespace gvom::sim
