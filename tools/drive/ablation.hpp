// What is taken from the map, one thing at a time, to see what it is good for.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/backend.hpp"
#include "core/config.hpp"
#include "tools/drive/rig.hpp"

namespace gvom::driving {

enum class Ablation : std::uint8_t {
  none,
  deskew_off,  ///< All returns of a sweep are moved by the pose at its end.
  memory_off,  ///< What leaves the window is forgotten (R17).
  one_lidar,   ///< All lidars but the first are silent.
  paper_r9,    ///< The ground is the lowest return of each column, as in the paper (`PaperGround`).
  paper_r13,   ///< Holes are found as in the paper (`PaperHoles`).
};

inline constexpr Ablation kAblations[] = {Ablation::none,      Ablation::deskew_off, Ablation::memory_off,
                                          Ablation::one_lidar, Ablation::paper_r9,   Ablation::paper_r13};

/// "none", "deskew-off", "memory-off", "one-lidar", "paper-R9", "paper-R13".
const char* name_of(Ablation ablation);
/// The error lists the names.
tl::expected<Ablation, std::string> find_ablation(const std::string& name);

/// The rig without its memory or its other lidars, if that is what is taken. Else the same. Error:
/// `one_lidar` of a vehicle that has one.
tl::expected<Rig, std::string> ablated(Rig rig, Ablation ablation);

/// All returns are of the sweep's stamp: nothing is deskewed.
void forget_times(Sweep& sweep);

/// Core's fusion on the CPU, with one of its rules replaced if that is what is taken.
std::unique_ptr<FusionBackend> make_fusion(const MapperConfig& config, Ablation ablation);

}  // namespace gvom::driving
