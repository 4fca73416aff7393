// A replay through the processes against gvom-map.
#pragma once

#include <string>

#include "tests/processes/graph.hpp"

namespace gvom::test {

/// Replays the vehicle's recording through the processes and compares the layers at its end with the last of
/// gvom-map's; every sweep must have been mapped and fused.
void check_replay(const Vehicle& vehicle, const std::string& rate, const std::string& expected_maps);

/// That every sweep of the ended graph was mapped and fused, so many in all; `lossless`: each with layers of
/// its own, else maps that come together share them.
void check_all_mapped(Graph& graph, int expected_maps, bool lossless);

}  // namespace gvom::test
