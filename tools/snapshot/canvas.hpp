// A picture in memory to draw on: pixels, rectangles and text, over Cairo. Coordinates are pixels, y down.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/snapshot/colour.hpp"

struct _cairo;
struct _cairo_surface;

namespace gvom::snapshot {

struct Point {
  double x = 0.0;
  double y = 0.0;
};

struct TextStyle {
  double size_px = 13.0;
  Rgb colour{40, 42, 48};
  bool bold = false;
};

class Canvas {
 public:
  Canvas(int width, int height, Rgb background);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

  /// Rows of `per_row` blocks of zoom x zoom pixels, exactly the colours; the first row is the lowest.
  /// Must lie inside.
  void blocks(int left, int top, int zoom, int per_row, const std::vector<Rgb>& colours);
  void rectangle(Point corner, double width, double height, Rgb colour);
  void outline(Point corner, double width, double height, Rgb colour);
  void line(Point from, Point to, double thickness, Rgb colour);
  void polygon(const std::vector<Point>& points, Rgb fill, Rgb edge);
  /// Text whose base line begins at `start`; returns the x at which it ends.
  double text(Point start, const std::string& words, const TextStyle& style);
  [[nodiscard]] double text_width(const std::string& words, const TextStyle& style) const;

  /// The colour of a pixel inside.
  [[nodiscard]] Rgb at(int x, int y) const;

  /// Appears under `path` whole or not at all (a temporary file beside it, then a rename). The error names
  /// the path.
  [[nodiscard]] tl::expected<void, std::string> write_png(const std::string& path) const;

 private:
  void use(const TextStyle& style) const;
  void use(Rgb colour) const;

  int width_;
  int height_;
  std::unique_ptr<_cairo_surface, void (*)(_cairo_surface*)> surface_;
  std::unique_ptr<_cairo, void (*)(_cairo*)> cairo_;
};

}  // namespace gvom::snapshot
