// What things are made of: how rays end in leaves, and how bright things are.
#pragma once

#include <cstdint>

namespace gvom::sim {

// Rates at which rays end in leaves, per metre. Labelled sweeps of real vehicles (RELLIS-3D) give 0.07 for
// bushes and 0.35 for trees' foliage: most rays go through a bush.
inline constexpr double kThinBush = 0.07;
inline constexpr double kDenseBush = 0.15;
inline constexpr double kCrown = 0.35;
inline constexpr double kTallGrass = 0.5;  // near the ground, where the stems are

// Rates of what hangs in the air.
inline constexpr double kThinDust = 0.02;
inline constexpr double kDenseDust = 0.1;
inline constexpr double kRain = 1.2e-4;  // 0.36 % of the rays end within 30 m

// Reflectivities, of 255.
inline constexpr std::uint8_t kBark = 60;
inline constexpr std::uint8_t kLeaves = 50;
inline constexpr std::uint8_t kStone = 90;
inline constexpr std::uint8_t kMasonry = 110;
inline constexpr std::uint8_t kCloth = 120;
inline constexpr std::uint8_t kPaint = 100;
inline constexpr std::uint8_t kTyre = 15;
inline constexpr std::uint8_t kHaze = 20;

}  // namespace gvom::sim
