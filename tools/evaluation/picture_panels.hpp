// What pictures of maps are put together from: panels of the 72 m around the vehicle, +x to the right.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/evaluation/frame.hpp"
#include "tools/snapshot/draw.hpp"

namespace gvom::evaluation {

inline constexpr int kShownColumns = 180;  ///< In x and y.
inline constexpr int kColumnPixels = 4;
inline constexpr int kPanelMargin = 24;
inline constexpr int kPanelTop = 84;

/// Which columns a panel shows.
class PanelWindow {
 public:
  /// @param edge_m of a column
  PanelWindow(const Frame& frame, double edge_m);

  [[nodiscard]] double edge_m() const { return edge_m_; }
  /// World voxel of a column of the panel, 0 .. kShownColumns - 1.
  [[nodiscard]] std::array<std::int64_t, 2> voxel(int x, int y) const {
    return {first_[0] + x, first_[1] + y};
  }
  /// Of the frame's arrays; -1 outside.
  [[nodiscard]] std::int64_t in_frame(int x, int y) const;
  /// Pixels of a point, in a panel whose left edge is at `left`.
  [[nodiscard]] snapshot::Point pixel(const Eigen::Vector2d& point_m, int left) const;
  [[nodiscard]] const Frame& frame() const { return frame_; }

 private:
  const Frame& frame_;
  double edge_m_;
  std::array<std::int64_t, 2> first_{};
};

/// Colours of all columns of a panel, by `colour_of(x, y)`.
template <typename ColourOf>
std::vector<snapshot::Rgb> paint_columns(ColourOf colour_of) {
  std::vector<snapshot::Rgb> colours;
  colours.reserve(static_cast<std::size_t>(kShownColumns) * kShownColumns);
  for (int y = 0; y < kShownColumns; ++y)
    for (int x = 0; x < kShownColumns; ++x) colours.push_back(colour_of(x, y));
  return colours;
}

/// A white picture with room for so many panels, and its title.
snapshot::Canvas make_canvas(int panels, const std::string& title);

struct PanelText {
  const char* name;
  const std::vector<snapshot::Swatch>& legend;
};
/// Panel `number` from the left: name, columns, vehicle, legend.
void draw_panel(snapshot::Canvas& canvas, int number, const PanelText& text, const PanelWindow& window,
                const std::vector<snapshot::Rgb>& colours);

snapshot::Rgb shade(snapshot::Rgb colour, double light);

/// Flags, and light and shadow on the ground.
snapshot::Rgb map_colour(const PanelWindow& window, int x, int y);
extern const std::vector<snapshot::Swatch> kMapLegend;

}  // namespace gvom::evaluation
