// One map of the montage, as data: a colour for every column and the legend that explains them.
#pragma once

#include <string>
#include <vector>

#include "tools/snapshot/colour.hpp"
#include "tools/snapshot/picture.hpp"

namespace gvom::snapshot {

/// A colour of its own meaning, "unknown" and the like.
struct Swatch {
  Rgb colour;
  std::string label;
};

/// A colour bar.
struct Bar {
  std::string caption;
  const ColourMap* map;
  Scale scale;
};

struct Panel {
  std::string name;  ///< The layer's name, and of the file that shows it.
  std::string title;
  std::string unit;          ///< Empty where the values have none.
  std::vector<Rgb> columns;  ///< n_xy * n_xy, indexed [y][x] like the layers.
  std::vector<Bar> bars;
  std::vector<Swatch> swatches;
};

/// The colours for what is not a value on a bar.
inline constexpr Rgb kPlainGround{246, 241, 226};  ///< Ground, and nothing wrong with it.
inline constexpr Rgb kSeenThrough{176, 208, 232};  ///< Rays went over it and found no ground.
inline constexpr Rgb kOpenSky{206, 230, 248};      ///< Nothing overhead.
inline constexpr Rgb kLethal{20, 8, 16};
inline constexpr Rgb kHardColour{200, 24, 28};
inline constexpr Rgb kSoftColour{66, 160, 74};
inline constexpr Rgb kNegativeColour{120, 40, 190};
inline constexpr Rgb kSteepColour{238, 140, 32};
inline constexpr Rgb kAssumedColour{236, 208, 110};

/// A colour for every column: `colour_of(index)`.
template <typename ColourOf>
std::vector<Rgb> paint(const LayersPicture& picture, ColourOf colour_of) {
  std::vector<Rgb> columns(picture.columns());
  for (std::size_t i = 0; i < columns.size(); ++i) columns[i] = colour_of(i);
  return columns;
}

/// The panel of one layer.
Panel make_panel(LayerId layer, const LayersPicture& picture);

/// Shaded relief with the obstacles on top: the whole map at a glance. Its name is "overview".
Panel make_overview(const LayersPicture& picture);

}  // namespace gvom::snapshot
