#include "tools/evaluation/recording_picture.hpp"

#include "tools/evaluation/picture_panels.hpp"

namespace gvom::evaluation {
namespace {

using snapshot::Rgb;
using snapshot::Swatch;

constexpr Rgb kTreeColour{96, 58, 24};
constexpr Rgb kBushColour{60, 150, 66};

const std::vector<Swatch> kKnownLegend = {{snapshot::kPlainGround, "drivable"},
                                          {kTreeColour, "tree"},
                                          {kBushColour, "bush"},
                                          {snapshot::kUnknown, "not known"}};

Rgb known_colour(Known known) {
  switch (known) {
    case Known::drivable:
      return snapshot::kPlainGround;
    case Known::tree:
      return kTreeColour;
    case Known::bush:
      return kBushColour;
    case Known::nothing:
      break;
  }
  return snapshot::kUnknown;
}

}  // namespace

snapshot::Canvas draw_recording(const KnownColumns& known, const Frame& frame, const std::string& title) {
  const bool knows = known.count(Known::drivable) > 0;
  snapshot::Canvas canvas = make_canvas(knows ? 2 : 1, title);
  const PanelWindow window(frame, known.edge_m());
  if (knows)
    draw_panel(canvas, 0, {"what is known", kKnownLegend}, window,
               paint_columns([&](int x, int y) { return known_colour(known.at(window.voxel(x, y))); }));
  draw_panel(canvas, knows ? 1 : 0, {"what the map says", kMapLegend}, window,
             paint_columns([&](int x, int y) { return map_colour(window, x, y); }));
  return canvas;
}

}  // namespace gvom::evaluation
