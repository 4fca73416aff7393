// What is really there, as the judges take it: the simulator's truth.
#pragma once

#include "tools/sim/ground_truth.hpp"

namespace gvom::evaluation {

using Truth = sim::GroundTruth;
using sim::ObjectClass;

}  // namespace gvom::evaluation
