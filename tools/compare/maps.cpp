#include "tools/compare/maps.hpp"

#include <utility>

namespace gvom::compare {

namespace {

constexpr std::pair<const char*, float * LayerArrays::*> kFloatArrays[] = {
    {"height", &LayerArrays::height},
    {"inferred_height", &LayerArrays::inferred_height},
    {"slope_x", &LayerArrays::slope_x},
    {"slope_y", &LayerArrays::slope_y},
    {"slope", &LayerArrays::slope},
    {"roughness", &LayerArrays::roughness},
    {"obstacle_density", &LayerArrays::obstacle_density},
    {"negative_delta", &LayerArrays::negative_delta},
    {"clearance", &LayerArrays::clearance},
    {"last_seen", &LayerArrays::last_seen}};
constexpr std::pair<const char*, std::uint8_t * LayerArrays::*> kByteArrays[] = {
    {"flags", &LayerArrays::flags}, {"visibility", &LayerArrays::visibility}, {"cost", &LayerArrays::cost}};
static_assert(std::size(kFloatArrays) == kFloatLayers);
static_assert(std::size(kFloatArrays) + std::size(kByteArrays) == kLayers);

// The differences of several arrays, below each other.
class Report {
 public:
  explicit Report(Same same) : same_(same) {}

  void add(const std::string& name, const ArrayView& expected, const ArrayView& found) {
    const std::string words = difference(name, expected, found, same_);
    if (!words.empty()) text_ += (text_.empty() ? "" : "\n") + words;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  Same same_;
  std::string text_;
};

ArrayView records_of(const BrickMapView& map) {
  return {
      {{"hits", "<u4"}, {"passes", "<u4"}, {"min_height_m", "<f4"}}, {map.shape.record_count}, map.records};
}

}  // namespace

std::string map_difference(const BrickMapView& expected, const BrickMapView& found, Same same) {
  Report report(same);
  const BrickMapShape& due = expected.shape;
  const BrickMapShape& is = found.shape;
  report.add("directory", view_of({due.brick_slots}, expected.directory),
             view_of({is.brick_slots}, found.directory));
  report.add("lookup", view_of({std::size_t{due.brick_count} * kBrickCells}, expected.lookup),
             view_of({std::size_t{is.brick_count} * kBrickCells}, found.lookup));
  report.add("columns", view_of({due.brick_count}, expected.columns),
             view_of({is.brick_count}, found.columns));
  report.add("lowest_ray_m", view_of({due.column_count}, expected.lowest_ray_m),
             view_of({is.column_count}, found.lowest_ray_m));
  report.add("records", records_of(expected), records_of(found));
  return report.text();
}

std::string layers_difference(const LayerArrays& expected, const LayerArrays& found, int size_xy, Same same) {
  Report report(same);
  const auto edge = static_cast<std::size_t>(size_xy);
  for (const auto& [name, array] : kFloatArrays)
    report.add(name, view_of<float>({edge, edge}, expected.*array),
               view_of<float>({edge, edge}, found.*array));
  for (const auto& [name, array] : kByteArrays)
    report.add(name, view_of<std::uint8_t>({edge, edge}, expected.*array),
               view_of<std::uint8_t>({edge, edge}, found.*array));
  return report.text();
}

}  // namespace gvom::compare
