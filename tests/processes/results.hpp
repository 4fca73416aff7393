// What a run left: gvom-map's and gvom-snapshot's folders, voxels, numbers in the logs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/processes/graph.hpp"

namespace gvom::test {

struct Voxel {
  std::int32_t x, y, z;  // of the world
  std::uint32_t hits, passes;
  float min_height_m;  // +infinity where hits is 0
};
bool operator==(const Voxel& a, const Voxel& b);

/// Number of maps in a folder of gvom-map's, the one of an index, and the last of them.
int map_count(const std::string& folder);
std::string map_of(const std::string& folder, int index);
std::string last_map(const std::string& folder);

/// Runs gvom-map over the vehicle's recording, with voxels; returns its folder, OUT in the vehicle's folder.
std::string map_offline(const Vehicle& vehicle, const std::string& out);

/// Which of the layers' files, or of what meta.json says of the moment, differ; empty if none.
std::string differences(const std::string& map_folder, const std::string& other_map_folder);

std::vector<Voxel> voxels_of(const std::string& map_folder);

/// A map's layer `visibility`, [y][x], and the world voxel of its column (0, 0).
std::vector<std::uint8_t> visibility_of(const std::string& map_folder);
std::vector<std::int32_t> origin_of(const std::string& map_folder);

/// The numbers before `words` in a text: numbers("7 of 9 sweeps mapped", "sweeps mapped") is {7, 9}.
std::vector<int> numbers_before(const std::string& text, const std::string& words);

}  // namespace gvom::test
