// How a drive can end badly.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/drive/vehicle.hpp"
#include "tools/sim/ground_truth.hpp"
#include "tools/sim/world.hpp"

namespace gvom::driving {

enum class Accident : std::uint8_t { hit, fell, tipped, high_centred, left_world };

struct Mishap {
  Accident what = Accident::hit;
  double time_s = 0;
  Eigen::Vector3d base_m = Eigen::Vector3d::Zero();  ///< base_link in odom.
  double speed_mps = 0;
  int object = -1;                                      ///< Its number in the world; -1: none.
  sim::ObjectClass against = sim::ObjectClass::ground;  ///< What it met.
};
const char* words_of(Accident what);
const char* words_of(sim::ObjectClass what);
/// "hit rock 17 at (12.3, -4.5) m after 8.1 s, at 3.2 m/s"
std::string describe(const Mishap& mishap);

/// Watches a vehicle for mishaps, step by step, and counts what it drives through.
class Watch {
 public:
  /// The world must outlive it.
  Watch(const sim::World& world, const VehicleModel& model);

  /// To be asked after each step of the vehicle. Solid things end its drive when its box meets them, from the
  /// ground clearance up to its height. A walker who walks into a vehicle at a stand does not, nor while he
  /// walks on through it: he minds no vehicle, and one who did would have stopped.
  std::optional<Mishap> look(const Vehicle& vehicle);

  [[nodiscard]] int bushes_driven_through() const { return bushes_; }
  [[nodiscard]] int grass_driven_through() const { return grass_; }

 private:
  [[nodiscard]] std::optional<Mishap> look_at_wheels(const Vehicle& vehicle);
  [[nodiscard]] std::optional<Mishap> look_at_things(const Vehicle& vehicle);
  void count(const sim::Primitive& body);

  const sim::World& world_;
  VehicleModel model_;
  std::array<std::optional<double>, kWheels> firm_m_;  // that each wheel last stood on
  std::vector<std::uint8_t> is_counted_;               // by object
  std::vector<std::uint8_t> walked_in_;                // by body of a walker: into the vehicle at a stand
  std::vector<int> near_;                              // bodies, of one look
  int bushes_ = 0;
  int grass_ = 0;
};

}  // namespace gvom::driving
