#include "tools/truth/dataset.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tools/common/npy.hpp"

namespace gvom::truth {
namespace {

using nlohmann::json;

tl::expected<json, std::string> read_json(const std::string& path) {
  std::ifstream file(path);
  if (!file) return tl::unexpected(path + ": cannot be opened");
  json parsed = json::parse(file, nullptr, false);
  if (parsed.is_discarded()) return tl::unexpected(path + ": is not JSON");
  return parsed;
}

/// Runs `take`, which reads keys; a missing or mistyped one becomes an error that names the file.
template <typename Take>
tl::expected<void, std::string> take_keys(const std::string& path, const Take& take) {
  try {
    take();
  } catch (const json::exception& error) {
    return tl::unexpected(path + ": " + error.what());
  }
  return {};
}

template <typename T>
tl::expected<void, std::string> read_layer(const std::string& path, std::size_t size_y, std::size_t size_x,
                                           std::vector<T>& out) {
  const auto array = npy::read_npy(path);
  if (!array) return tl::unexpected(array.error());
  if (array->shape != std::vector<std::size_t>{size_y, size_x})
    return tl::unexpected(path + ": its shape is not " + std::to_string(size_y) + " x " +
                          std::to_string(size_x));
  auto values = array->values<T>();
  if (!values) return tl::unexpected(path + ": " + values.error());
  out = std::move(*values);
  return {};
}

void take_objects(const json& meta, Truth& truth) {
  for (const json& object : meta.at("objects"))
    truth.objects.push_back({object.at("kind").get<std::string>(), object.at("height_m").get<double>()});
  for (const json& point : meta.at("person_xy"))
    truth.person.push_back({point.at(0).get<double>(), point.at(1).get<double>(), point.at(2).get<double>()});
}

tl::expected<void, std::string> read_layers(const std::string& directory, Truth& truth) {
  const auto read = [&](const char* name, auto& layer) {
    return read_layer(directory + "/" + name + ".npy", static_cast<std::size_t>(truth.size_y),
                      static_cast<std::size_t>(truth.size_x), layer);
  };
  return read("ground_lowest", truth.ground_lowest)
      .and_then([&] { return read("ground_mean", truth.ground_mean); })
      .and_then([&] { return read("drop", truth.drop_m); })
      .and_then([&] { return read("clearance", truth.clearance); })
      .and_then([&] { return read("class", truth.classes); })
      .and_then([&] { return read("object", truth.object); });
}

tl::expected<FrameInfo, std::string> read_info(const std::string& directory) {
  const std::string path = directory + "/meta.json";
  const auto meta = read_json(path);
  if (!meta) return tl::unexpected(meta.error());
  FrameInfo info;
  info.directory = directory;
  const auto taken = take_keys(path, [&] {
    info.stamp_ns = meta->at("stamp_ns").get<std::int64_t>();
    info.size = meta->at("size").at(0).get<int>();
    info.resolution_m = meta->at("resolution_m").at(0).get<double>();
    for (std::size_t axis = 0; axis < 2; ++axis) {
      info.origin[axis] = meta->at("origin").at(axis).get<std::int64_t>();
      info.base_m[axis] = meta->at("base_position_m").at(axis).get<double>();
    }
  });
  if (!taken) return tl::unexpected(taken.error());
  return info;
}

bool is_frame_name(const std::string& name) {
  return name.size() == 6 &&
         std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

tl::expected<Truth, std::string> read_truth(const std::string& directory) {
  const std::string path = directory + "/truth.json";
  const auto meta = read_json(path);
  if (!meta) return tl::unexpected(meta.error());
  Truth truth;
  const auto taken = take_keys(path, [&] {
    truth.resolution_m = meta->at("resolution_m").get<double>();
    truth.origin = {meta->at("origin").at(0).get<std::int64_t>(),
                    meta->at("origin").at(1).get<std::int64_t>()};
    truth.size_x = meta->at("size").at(0).get<int>();
    truth.size_y = meta->at("size").at(1).get<int>();
    take_objects(*meta, truth);
  });
  if (!taken) return tl::unexpected(taken.error());
  const auto read = read_layers(directory, truth);
  if (!read) return tl::unexpected(read.error());
  const auto known = static_cast<std::int32_t>(truth.objects.size());
  if (std::any_of(truth.object.begin(), truth.object.end(),
                  [&](std::int32_t number) { return number >= known; }))
    return tl::unexpected(directory + "/object.npy: names an object that " + path + " does not list");
  return truth;
}

tl::expected<std::vector<FrameInfo>, std::string> list_frames(const std::string& directory) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error))
    if (is_frame_name(entry.path().filename().string())) names.push_back(entry.path().string());
  if (error) return tl::unexpected(directory + ": " + error.message());
  if (names.empty()) return tl::unexpected(directory + ": holds no maps (DIR/000000 and so on)");
  std::sort(names.begin(), names.end());
  std::vector<FrameInfo> frames;
  for (const std::string& name : names) {
    const auto info = read_info(name);
    if (!info) return tl::unexpected(info.error());
    frames.push_back(*info);
  }
  return frames;
}

tl::expected<Frame, std::string> read_frame(const FrameInfo& info) {
  Frame frame;
  frame.info = info;
  const auto size = static_cast<std::size_t>(info.size);
  const auto read = [&](const char* name, auto& layer) {
    return read_layer(info.directory + "/" + name + ".npy", size, size, layer);
  };
  const auto all = read("height", frame.height)
                       .and_then([&] { return read("clearance", frame.clearance); })
                       .and_then([&] { return read("flags", frame.flags); })
                       .and_then([&] { return read("visibility", frame.visibility); });
  if (!all) return tl::unexpected(all.error());
  return frame;
}

}  // namespace gvom::truth
