// Curves over a common axis.
#pragma once

#include <string>
#include <vector>

#include "tools/snapshot/canvas.hpp"

namespace gvom::driving {

struct Curve {
  std::string label;
  snapshot::Rgb colour;
  bool dashed = false;
  double step = 1;  ///< From one value to the next along x.
  std::vector<double> values;
};

struct Axes {
  std::string title, x_label;
  bool logarithmic = false;  ///< The values, that are then 1 or more; else from 0 on.
};

/// A rectangle of pixels with its axes' numbers left of it and below.
struct PlotArea {
  double left, top, width, height;
};

/// x from 0 on; the title above, the curves' labels in the upper right corner, `x_label` below.
void draw_plot(snapshot::Canvas& canvas, const PlotArea& area, const Axes& axes,
               const std::vector<Curve>& curves);

/// A line that may be dashed, through all points.
void draw_polyline(snapshot::Canvas& canvas, const std::vector<snapshot::Point>& points, double thickness,
                   snapshot::Rgb colour, bool dashed);

}  // namespace gvom::driving
