#include "tools/snapshot/folder.hpp"

#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "tools/common/npy.hpp"

namespace gvom::snapshot {
namespace {

using nlohmann::json;

/// Fills all of the picture but the arrays. Throws json::exception, which names the key.
void take_meta(const json& meta, LayersPicture& picture) {
  const auto size = meta.at("size").get<std::array<std::int32_t, 3>>();
  const auto resolution_m = meta.at("resolution_m").get<std::array<double, 2>>();
  picture.n_xy = size[0];
  picture.n_z = size[2];
  picture.resolution_xy_m = resolution_m[0];
  picture.resolution_z_m = resolution_m[1];
  picture.origin_voxels = meta.at("origin").get<std::array<std::int32_t, 3>>();
  picture.stamp_ns = meta.at("stamp_ns").get<std::int64_t>();
  picture.vehicle = meta.value("vehicle", "");
  picture.maps_in_window = meta.value("maps_in_window", std::uint32_t{0});
  picture.base_position_m.fill(std::nan(""));
  if (meta.contains("base_position_m")) meta.at("base_position_m").get_to(picture.base_position_m);
  if (meta.contains("base_orientation_xyzw"))
    meta.at("base_orientation_xyzw").get_to(picture.base_orientation_xyzw);
}

/// A lidar that never came has no age_s.
void take_lidars(const json& lidars, LayersPicture& picture) {
  for (const json& lidar : lidars) {
    LidarLine line;
    line.name = lidar.at("name").get<std::string>();
    line.maps_in_window = lidar.at("maps_in_window").get<std::uint32_t>();
    line.missing = lidar.at("missing").get<bool>();
    line.age_s = lidar.value("age_s", std::nan(""));
    line.maps_lost = lidar.value("maps_lost", std::uint64_t{0});
    picture.lidars.push_back(line);
  }
}

tl::expected<void, std::string> read_meta(const std::string& path, LayersPicture& picture) {
  std::ifstream file(path);
  if (!file) return tl::make_unexpected(path + ": cannot be opened");
  try {
    const json meta = json::parse(file);
    take_meta(meta, picture);
    if (meta.contains("lidars")) take_lidars(meta.at("lidars"), picture);
  } catch (const json::exception& error) {
    return tl::make_unexpected(path + ": " + error.what());
  }
  if (picture.n_xy <= 0 || picture.n_xy > 4096 || !(picture.resolution_xy_m > 0))
    return tl::make_unexpected(path + ": size or resolution_m is not that of a grid");
  return {};
}

template <typename T>
tl::expected<const T*, std::string> read_layer(const std::string& path, std::size_t n_xy,
                                               std::vector<T>& out) {
  auto array = npy::read_npy(path);
  if (!array) return tl::make_unexpected(array.error());
  if (array->shape != std::vector<std::size_t>{n_xy, n_xy})
    return tl::make_unexpected(path + ": its shape is not the size in meta.json");
  auto values = array->values<T>();
  if (!values) return tl::make_unexpected(path + ": " + values.error());
  out = std::move(*values);
  return out.data();
}

json meta_of(const LayersPicture& picture) {
  json meta = {{"stamp_ns", picture.stamp_ns},
               {"origin", picture.origin_voxels},
               {"size", {picture.n_xy, picture.n_xy, picture.n_z}},
               {"resolution_m", {picture.resolution_xy_m, picture.resolution_z_m}},
               {"maps_in_window", picture.maps_in_window},
               {"base_position_m", picture.base_position_m},
               {"base_orientation_xyzw", picture.base_orientation_xyzw},
               {"vehicle", picture.vehicle},
               {"lidars", json::array()}};
  for (const LidarLine& lidar : picture.lidars) {
    json line = {{"name", lidar.name},
                 {"maps_in_window", lidar.maps_in_window},
                 {"missing", lidar.missing},
                 {"maps_lost", lidar.maps_lost}};
    if (std::isfinite(lidar.age_s)) line["age_s"] = lidar.age_s;
    meta["lidars"].push_back(line);
  }
  return meta;
}

std::string layer_path(const std::string& folder, std::size_t layer) {
  return folder + "/" + std::string(kLayerNames[layer]) + ".npy";
}

}  // namespace

tl::expected<StoredLayers, std::string> read_folder(const std::string& folder) {
  StoredLayers stored;
  LayersPicture& picture = stored.picture;
  if (auto read = read_meta(folder + "/meta.json", picture); !read) return tl::make_unexpected(read.error());
  const auto n_xy = static_cast<std::size_t>(picture.n_xy);
  for (std::size_t i = 0; i < stored.float_values.size(); ++i) {
    const auto values = read_layer(layer_path(folder, i), n_xy, stored.float_values[i]);
    if (!values) return tl::make_unexpected(values.error());
    picture.float_layers[i] = *values;
  }
  for (std::size_t i = 0; i < stored.byte_values.size(); ++i) {
    const auto values = read_layer(layer_path(folder, kFloatLayers + i), n_xy, stored.byte_values[i]);
    if (!values) return tl::make_unexpected(values.error());
    picture.byte_layers[i] = *values;
  }
  return stored;
}

tl::expected<void, std::string> write_folder(const std::string& folder, const LayersPicture& picture) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return tl::make_unexpected(folder + ": cannot be made: " + error.message());
  const std::vector<std::size_t> shape(2, static_cast<std::size_t>(picture.n_xy));
  for (std::size_t i = 0; i < kLayers; ++i) {
    const auto written =
        i < kFloatLayers
            ? npy::write_npy(layer_path(folder, i), shape, picture.float_layers[i])
            : npy::write_npy(layer_path(folder, i), shape, picture.byte_layers[i - kFloatLayers]);
    if (!written) return written;
  }
  const std::string path = folder + "/meta.json";
  std::ofstream file(path);
  file << meta_of(picture).dump(2) << '\n';
  file.close();
  if (!file) return tl::make_unexpected(path + ": cannot be written");
  return {};
}

}  // namespace gvom::snapshot
