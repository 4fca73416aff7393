// What things are made of, in one place: how much of a ray they stop, and how bright they are to a lidar.
#pragma once

#include <cstdint>

namespace gvom::sim {

// Rates at which rays end inside of what is not solid, per metre of their way. Leaves measured on real
// recordings (RELLIS: hits per metre of ray inside labelled bushes and trees): bushes are far thinner than
// they look, because a lidar's return needs a good part of its beam, which small leaves give it seldom.
inline constexpr double kBushHitsPerM = 0.07;       ///< A real bush; one sweep meets it with few rays.
inline constexpr double kDenseBushHitsPerM = 0.15;  ///< The densest that are still bushes.
inline constexpr double kCrownHitsPerM = 0.35;      ///< Foliage of trees.
inline constexpr double kGrassHitsPerM = 0.5;       ///< Tall grass: stems stand close, a flat ray goes 2 m.
inline constexpr double kThinDustHitsPerM = 0.02;   ///< Dust that hangs in the air, rays of 30 m pass half.
inline constexpr double kDustHitsPerM = 0.1;        ///< A cloud behind a vehicle.
inline constexpr double kRainHitsPerM = 1e-4;       ///< Rain: of the rays to 30 m, 3 in 1000 end on drops.

// Diffuse reflectivity in percent at 865 to 905 nm, as far as it fills the beam.
inline constexpr std::uint8_t kBark = 40;
inline constexpr std::uint8_t kLeaves = 30;
inline constexpr std::uint8_t kGrass = 30;
inline constexpr std::uint8_t kStone = 35;
inline constexpr std::uint8_t kPlaster = 50;  ///< Walls of houses.
inline constexpr std::uint8_t kPaint = 30;    ///< Of cars.
inline constexpr std::uint8_t kCloth = 50;
inline constexpr std::uint8_t kSoil = 30;
inline constexpr std::uint8_t kDust = 20;
inline constexpr std::uint8_t kDrop = 20;

}  // namespace gvom::sim
