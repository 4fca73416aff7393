// What things are made of, in one place: how much of a ray they stop, and how bright they are to a lidar.
#pragma once

#include <cstdint>

namespace gvom::sim {

// Rates at which rays end inside of what is not solid, per metre of their way. Leaves measured on real
// recordings (RELLIS-3D: hits per metre of ray inside labelled bushes and trees): bushes are far thinner than
// they look, because a return needs a good part of the beam, which small leaves seldom give it.
inline constexpr double kThinBush = 0.07;   ///< A real bush; one sweep meets it with few rays.
inline constexpr double kDenseBush = 0.15;  ///< The densest that are still bushes.
inline constexpr double kCrown = 0.35;      ///< Foliage of trees.
inline constexpr double kTallGrass = 0.5;   ///< Stems stand close: a flat ray goes 2 m through them.
inline constexpr double kThinDust = 0.02;   ///< Dust that hangs in the air: half of the rays pass 35 m of it.
inline constexpr double kDenseDust = 0.1;   ///< A cloud behind a vehicle.
inline constexpr double kRain = 1.2e-4;     ///< Of the rays to 30 m, 0.36 % end on drops.

// Diffuse reflectivity in percent at 865 to 905 nm, as far as it fills the beam.
inline constexpr std::uint8_t kBark = 40;
inline constexpr std::uint8_t kLeaves = 30;
inline constexpr std::uint8_t kStone = 35;
inline constexpr std::uint8_t kMasonry = 50;
inline constexpr std::uint8_t kPaint = 30;
inline constexpr std::uint8_t kTyre = 5;
inline constexpr std::uint8_t kCloth = 50;
inline constexpr std::uint8_t kDarkSoil = 15;    ///< The ground's goes from this
inline constexpr std::uint8_t kBrightSoil = 60;  ///< to this, from patch to patch; the median is 26.
inline constexpr std::uint8_t kHaze = 20;        ///< Dust and drops.

}  // namespace gvom::sim
