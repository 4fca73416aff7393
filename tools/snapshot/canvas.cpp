#include "tools/snapshot/canvas.hpp"

#include <cairo.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace gvom::snapshot {

Canvas::Canvas(int width, int height, Rgb background)
    : width_(width),
      height_(height),
      surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), cairo_surface_destroy),
      cairo_(cairo_create(surface_.get()), cairo_destroy) {
  rectangle({0, 0}, width, height, background);
}

void Canvas::use(Rgb colour) const {
  cairo_set_source_rgb(cairo_.get(), colour.r / 255.0, colour.g / 255.0, colour.b / 255.0);
}

void Canvas::use(const TextStyle& style) const {
  cairo_select_font_face(cairo_.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_.get(), style.size_px);
  use(style.colour);
}

void Canvas::blocks(int left, int top, int zoom, int per_row, const std::vector<Rgb>& colours) {
  cairo_surface_flush(surface_.get());
  unsigned char* data = cairo_image_surface_get_data(surface_.get());
  const int stride = cairo_image_surface_get_stride(surface_.get());
  const int rows = static_cast<int>(colours.size()) / per_row;
  for (int y = 0; y < rows * zoom; ++y) {
    const Rgb* from = colours.data() + static_cast<std::ptrdiff_t>(rows - 1 - y / zoom) * per_row;
    auto* to = reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(top + y) * stride) + left;
    for (int x = 0; x < per_row * zoom; ++x) {
      const Rgb colour = from[x / zoom];
      to[x] = (std::uint32_t{colour.r} << 16) | (std::uint32_t{colour.g} << 8) | colour.b;
    }
  }
  cairo_surface_mark_dirty(surface_.get());
}

void Canvas::rectangle(Point corner, double width, double height, Rgb colour) {
  use(colour);
  cairo_rectangle(cairo_.get(), corner.x, corner.y, width, height);
  cairo_fill(cairo_.get());
}

void Canvas::outline(Point corner, double width, double height, Rgb colour) {
  use(colour);
  cairo_set_line_width(cairo_.get(), 1.0);
  cairo_rectangle(cairo_.get(), corner.x - 0.5, corner.y - 0.5, width + 1, height + 1);
  cairo_stroke(cairo_.get());
}

void Canvas::line(Point from, Point to, double thickness, Rgb colour) {
  use(colour);
  cairo_set_line_width(cairo_.get(), thickness);
  cairo_move_to(cairo_.get(), from.x, from.y);
  cairo_line_to(cairo_.get(), to.x, to.y);
  cairo_stroke(cairo_.get());
}

void Canvas::polygon(const std::vector<Point>& points, Rgb fill, Rgb edge) {
  cairo_new_path(cairo_.get());
  for (const Point& p : points) cairo_line_to(cairo_.get(), p.x, p.y);
  cairo_close_path(cairo_.get());
  use(fill);
  cairo_fill_preserve(cairo_.get());
  use(edge);
  cairo_set_line_width(cairo_.get(), 2.0);
  cairo_stroke(cairo_.get());
}

double Canvas::text(Point start, const std::string& words, const TextStyle& style) {
  use(style);
  cairo_move_to(cairo_.get(), start.x, start.y);
  cairo_show_text(cairo_.get(), words.c_str());
  return start.x + text_width(words, style);
}

double Canvas::text_width(const std::string& words, const TextStyle& style) const {
  use(style);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo_.get(), words.c_str(), &extents);
  return extents.x_advance;
}

Rgb Canvas::at(int x, int y) const {
  cairo_surface_flush(surface_.get());
  const unsigned char* row = cairo_image_surface_get_data(surface_.get()) +
                             static_cast<std::ptrdiff_t>(y) * cairo_image_surface_get_stride(surface_.get());
  const std::uint32_t pixel = reinterpret_cast<const std::uint32_t*>(row)[x];
  return {static_cast<std::uint8_t>(pixel >> 16), static_cast<std::uint8_t>(pixel >> 8),
          static_cast<std::uint8_t>(pixel)};
}

tl::expected<void, std::string> Canvas::write_png(const std::string& path) const {
  const std::string partial = path + ".part";
  const cairo_status_t status = cairo_surface_write_to_png(surface_.get(), partial.c_str());
  if (status != CAIRO_STATUS_SUCCESS)
    return tl::make_unexpected(path + ": cannot write the picture: " + cairo_status_to_string(status));
  if (std::rename(partial.c_str(), path.c_str()) != 0)
    return tl::make_unexpected(path + ": cannot write the picture: " + std::strerror(errno));
  return {};
}

}  // namespace gvom::snapshot
