#include "tools/drive/mishap.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/drive/body_box.hpp"
#include "tools/sim/truth_column.hpp"

namespace gvom::driving {
namespace {

constexpr double kAtAStand_mps = 0.05;

Mishap mishap_of(const Vehicle& vehicle, Accident what) {
  return {what, vehicle.time_s(), vehicle.T_odom_base().translation_m, vehicle.state().speed_mps};
}

/// About the outer wheels: by its weight on a slope, and by what pulls it outwards in a bend.
bool tips(const Vehicle& vehicle) {
  const VehicleModel& model = vehicle.model();
  const VehicleState& state = vehicle.state();
  const double roll_rad = vehicle.stance().roll_rad;
  const double right_mps2 = state.speed_mps * state.speed_mps * state.curvature_per_m;
  const double across_mps2 = kGravity_mps2 * std::sin(roll_rad) + right_mps2 * std::cos(roll_rad);
  const double down_mps2 = kGravity_mps2 * std::cos(roll_rad) - right_mps2 * std::sin(roll_rad);
  return std::abs(across_mps2) * model.centre_of_mass_m > 0.5 * model.limits.track_m * down_mps2 ||
         std::abs(vehicle.stance().pitch_rad) > model.tip_pitch_rad();
}

}  // namespace

const char* words_of(sim::ObjectClass what) {
  constexpr const char* kNames[] = {"ground", "tree",  "bush", "rock", "ditch", "step face",  "branch",
                                    "person", "grass", "wall", "car",  "water", "dark ground"};
  return kNames[static_cast<int>(what)];
}

const char* words_of(Accident what) {
  switch (what) {
    case Accident::hit:
      return "hit";
    case Accident::fell:
      return "fell";
    case Accident::tipped:
      return "tipped over";
    case Accident::high_centred:
      return "high-centred";
    case Accident::left_world:
      return "left the world";
  }
  return "";
}

std::string describe(const Mishap& mishap) {
  std::string met;
  if (mishap.against != sim::ObjectClass::ground)
    met = std::string(mishap.what == Accident::fell ? " into " : " ") + words_of(mishap.against);
  if (mishap.object >= 0) met += " " + std::to_string(mishap.object);
  char text[160];
  std::snprintf(text, sizeof text, "%s%s at (%.1f, %.1f) m after %.1f s, at %.1f m/s", words_of(mishap.what),
                met.c_str(), mishap.base_m.x(), mishap.base_m.y(), mishap.time_s, mishap.speed_mps);
  return text;
}

Watch::Watch(const sim::World& world, const VehicleModel& model)
    : world_(world), model_(model), is_counted_(world.data().objects.size(), 0) {}

std::optional<Mishap> Watch::look(const Vehicle& vehicle) {
  const sim::Area area = world_.terrain().area();
  const planner::Pose2& place = vehicle.state().place;
  if (place.x_m < area.min_x_m || place.y_m < area.min_y_m || place.x_m > area.max_x_m ||
      place.y_m > area.max_y_m)
    return mishap_of(vehicle, Accident::left_world);
  if (const auto wheels = look_at_wheels(vehicle)) return wheels;
  const Stance& stance = vehicle.stance();
  if (tips(vehicle)) return mishap_of(vehicle, Accident::tipped);
  if (belly_ground_m(world_.terrain(), model_, place, stance) > model_.limits.ground_clearance_m)
    return mishap_of(vehicle, Accident::high_centred);
  return look_at_things(vehicle);
}

/// A wheel falls where it is lower than the last firm ground by more than its radius, and runs against what
/// lifts it as much at once.
std::optional<Mishap> Watch::look_at_wheels(const Vehicle& vehicle) {
  const Stance& stance = vehicle.stance();
  for (int wheel = 0; wheel < kWheels; ++wheel) {
    if (stance.is_firm[wheel] || !firm_m_[wheel]) {
      firm_m_[wheel] = stance.touched_m[wheel];
      continue;
    }
    const double rises_m = stance.wheel_m[wheel] - *firm_m_[wheel];
    if (std::abs(rises_m) <= model_.wheel_radius_m) continue;
    Mishap mishap = mishap_of(vehicle, rises_m < 0 ? Accident::fell : Accident::hit);
    mishap.against = rises_m < 0 ? sim::ObjectClass::ditch : sim::ObjectClass::step_face;
    return mishap;
  }
  return {};
}

void Watch::count(const sim::Primitive& body) {
  if (is_counted_[body.object] != 0) return;
  const sim::Kind kind = world_.data().objects[body.object].kind;
  if (kind != sim::Kind::bush && kind != sim::Kind::grass) return;
  is_counted_[body.object] = 1;
  (kind == sim::Kind::bush ? bushes_ : grass_) += 1;
}

std::optional<Mishap> Watch::look_at_things(const Vehicle& vehicle) {
  const BodyBox box(model_, vehicle.T_odom_base());
  const Eigen::Vector3d size = box.upper() - box.lower();
  near_.clear();
  const auto pieces = [](double length_m) { return static_cast<int>(length_m / sim::BinGrid::kEdge) + 1; };
  for (int i = 0; i <= pieces(size.x()); ++i)
    for (int k = 0; k <= pieces(size.y()); ++k)
      world_.bins().visit_over(box.lower().x() + size.x() * i / pieces(size.x()),
                               box.lower().y() + size.y() * k / pieces(size.y()),
                               [&](int number) { near_.push_back(number); });
  std::sort(near_.begin(), near_.end());
  near_.erase(std::unique(near_.begin(), near_.end()), near_.end());

  const auto hit = [&](const sim::Primitive& body) {
    Mishap mishap = mishap_of(vehicle, Accident::hit);
    mishap.object = body.object;
    mishap.against = sim::class_of(world_.data().objects[body.object].kind);
    return mishap;
  };
  for (const int number : near_) {
    const sim::Primitive& body = world_.primitives()[number];
    if (!box.meets(body)) continue;
    if (body.is_solid()) return hit(body);
    count(body);
  }
  const bool stands = std::abs(vehicle.state().speed_mps) < kAtAStand_mps;
  std::optional<Mishap> mishap;
  const auto walkers = world_.walkers_at(vehicle.time_s());
  walked_in_.resize(walkers.size());
  for (std::size_t i = 0; i < walkers.size(); ++i) {
    const bool meets = box.meets(walkers[i]);
    if (meets && !stands && walked_in_[i] == 0) mishap = hit(walkers[i]);
    walked_in_[i] = meets && (stands || walked_in_[i] != 0) ? 1 : 0;
  }
  return mishap;
}

}  // namespace gvom::driving
