#include "tests/processes/results.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

#include <nlohmann/json.hpp>

#include "tools/common/npy.hpp"

namespace gvom::test {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> maps_in(const std::string& folder) {
  std::vector<std::string> maps;
  for (const auto& entry : fs::directory_iterator(folder))
    if (fs::exists(entry.path() / "height.npy")) maps.push_back(entry.path());
  std::sort(maps.begin(), maps.end());
  return maps;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

nlohmann::json meta_of(const std::string& folder) {
  return nlohmann::json::parse(bytes_of(folder + "/meta.json"));
}

}  // namespace

bool operator==(const Voxel& a, const Voxel& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.hits == b.hits && a.passes == b.passes &&
         a.min_height_m == b.min_height_m;
}

int map_count(const std::string& folder) {
  return static_cast<int>(maps_in(folder).size());
}

std::string map_of(const std::string& folder, int index) {
  const auto maps = maps_in(folder);
  REQUIRE((index >= 0 && static_cast<std::size_t>(index) < maps.size()));
  return maps[static_cast<std::size_t>(index)];
}

std::string last_map(const std::string& folder) {
  return map_of(folder, map_count(folder) - 1);
}

std::string map_offline(const Vehicle& vehicle, const std::string& out) {
  const std::string folder = vehicle.folder + "/" + out;
  const Ended mapped =
      run("gvom-map" + vehicle.variant, vehicle.arguments({"--voxels", "--out", folder}), vehicle.folder);
  INFO(mapped.output);
  REQUIRE(mapped.code == 0);
  return folder;
}

std::string differences(const std::string& map_folder, const std::string& other_map_folder) {
  std::string differing;
  for (const char* layer :
       {"height", "inferred_height", "slope_x", "slope_y", "slope", "roughness", "obstacle_density",
        "negative_delta", "clearance", "last_seen", "flags", "visibility", "cost"}) {
    const std::string file = std::string("/") + layer + ".npy";
    const std::string bytes = bytes_of(map_folder + file);
    if (bytes.empty() || bytes != bytes_of(other_map_folder + file)) differing += std::string(layer) + " ";
  }
  const auto meta = meta_of(map_folder);
  const auto other = meta_of(other_map_folder);
  for (const char* key : {"stamp_ns", "origin", "size", "resolution_m", "maps_in_window"})
    if (meta.at(key) != other.at(key)) differing += std::string(key) + " ";
  return differing;
}

std::vector<Voxel> voxels_of(const std::string& map_folder) {
  const auto array = npy::read_npy(map_folder + "/voxels.npy");
  REQUIRE(array);
  const auto voxels = array->records<Voxel>(
      {{"x", "<i4"}, {"y", "<i4"}, {"z", "<i4"}, {"hits", "<u4"}, {"passes", "<u4"}, {"min_height", "<f4"}});
  REQUIRE(voxels);
  return *voxels;
}

std::vector<std::uint8_t> visibility_of(const std::string& map_folder) {
  const auto array = npy::read_npy(map_folder + "/visibility.npy");
  REQUIRE(array);
  const auto values = array->values<std::uint8_t>();
  REQUIRE(values);
  return *values;
}

std::vector<std::int32_t> origin_of(const std::string& map_folder) {
  return meta_of(map_folder).at("origin").get<std::vector<std::int32_t>>();
}

std::vector<int> numbers_before(const std::string& text, const std::string& words) {
  std::smatch match;
  if (!std::regex_search(text, match, std::regex("(\\d+)(?: of (\\d+))? " + words))) return {};
  std::vector<int> numbers{std::stoi(match[1])};
  if (match[2].matched) numbers.push_back(std::stoi(match[2]));
  return numbers;
}

}  // namespace gvom::test
