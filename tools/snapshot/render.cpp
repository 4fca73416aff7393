#include "tools/snapshot/render.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "ipc/freshness.hpp"
#include "tools/snapshot/draw.hpp"

namespace gvom::snapshot {
namespace {

constexpr int kMargin = 28;
constexpr int kMontageMap_px = 512;
constexpr int kLayerMap_px = 768;
constexpr int kMinLayerZoom = 2;
constexpr double kStaleAge_s = std::chrono::duration<double>(ipc::kDefaultMaxAge).count();

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

/// The sensors' clock; with the date where it plausibly counts from 1970.
std::string stamp_text(std::int64_t stamp_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t seconds = stamp_ns / kSecond_ns;
  std::string text = format("stamp %.3f s", static_cast<double>(stamp_ns) * 1e-9);
  if (seconds < 1'000'000'000) return text;
  const std::time_t time = seconds;
  std::tm utc{};
  gmtime_r(&time, &utc);
  char date[48];
  std::strftime(date, sizeof date, "  (%Y-%m-%d %H:%M:%S UTC)", &utc);
  return text + date;
}

std::string maps_text(std::uint32_t maps) {
  return format(maps == 1 ? "%u map" : "%u maps", maps);
}

std::string lidar_text(const LidarLine& lidar) {
  if (lidar.missing) {
    const std::string since = std::isnan(lidar.age_s) ? "never came" : format("last %.1f s ago", lidar.age_s);
    return lidar.name + " MISSING, " + since;
  }
  std::string text =
      lidar.name + ": " + maps_text(lidar.maps_in_window) + format(", newest %.2f s ago", lidar.age_s);
  if (lidar.maps_lost > 0) text += format(", %llu lost", static_cast<unsigned long long>(lidar.maps_lost));
  return text;
}

int montage_zoom(int n_xy) {
  return std::max(1, static_cast<int>(std::lround(static_cast<double>(kMontageMap_px) / n_xy)));
}

}  // namespace

void draw_header(Canvas& canvas, double left, const LayersPicture& picture) {
  const auto& base = picture.base_position_m;
  double x =
      canvas.text({left, 34}, picture.vehicle.empty() ? "gvom" : picture.vehicle, {24, kInk, true}) + 22;
  x = canvas.text({x, 34}, stamp_text(picture.stamp_ns), {15, kInk}) + 22;
  if (!std::isnan(picture.age_s)) {
    const bool stale = picture.age_s > kStaleAge_s;
    const std::string age = std::isinf(picture.age_s) ? "age unknown" : format("age %.2f s", picture.age_s);
    x = canvas.text({x, 34}, stale ? "STALE: " + age : age, {15, stale ? kAlarm : kInk, stale}) + 22;
  }
  if (std::isfinite(base[0]))
    canvas.text({x, 34}, format("at x %.1f, y %.1f, z %.1f m", base[0], base[1], base[2]), {15, kFaintInk});

  x = canvas.text({left, 60}, maps_text(picture.maps_in_window) + " in the window", {14, kFaintInk}) + 22;
  for (const bool missing : {true, false})  // what is missing must not fall off the edge
    for (const LidarLine& lidar : picture.lidars)
      if (lidar.missing == missing)
        x = canvas.text({x, 60}, lidar_text(lidar), {14, missing ? kAlarm : kInk, missing}) + 22;
}

MapArea layer_map_area(int n_xy) {
  const int zoom =
      std::max(kMinLayerZoom, static_cast<int>(std::lround(static_cast<double>(kLayerMap_px) / n_xy)));
  return {kMargin, kHeaderHeight + kTitleHeight, n_xy, zoom};
}

Canvas render_layer(const LayersPicture& picture, const Panel& panel) {
  const MapArea area = layer_map_area(picture.n_xy);
  const int width = std::max(area.left + area.size_px() + kLegendWidth + kMargin, 960);
  Canvas canvas(width, area.top + area.size_px() + kFooterHeight + 12, kPaper);
  draw_header(canvas, kMargin, picture);
  draw_panel(canvas, area, picture, panel);
  return canvas;
}

Canvas render_montage(const LayersPicture& picture) {
  constexpr std::array<LayerId, 11> kOrder = {
      LayerId::height,         LayerId::inferred_height, LayerId::slope,     LayerId::obstacle_density,
      LayerId::negative_delta, LayerId::clearance,       LayerId::roughness, LayerId::cost,
      LayerId::flags,          LayerId::visibility,      LayerId::last_seen};
  constexpr int kAcross = 4;
  constexpr int kDown = 3;
  const int zoom = montage_zoom(picture.n_xy);
  const int cell_width = picture.n_xy * zoom + kLegendWidth + kMargin;
  const int cell_height = kTitleHeight + picture.n_xy * zoom + kFooterHeight + 10;
  Canvas canvas(kMargin + kAcross * cell_width, kHeaderHeight + kDown * cell_height + 8, kPaper);
  draw_header(canvas, kMargin, picture);
  for (int slot = 0; slot < kAcross * kDown; ++slot) {
    const MapArea area{kMargin + slot % kAcross * cell_width,
                       kHeaderHeight + kTitleHeight + slot / kAcross * cell_height, picture.n_xy, zoom};
    const Panel panel =
        slot == 0 ? make_overview(picture) : make_panel(kOrder[static_cast<std::size_t>(slot - 1)], picture);
    draw_panel(canvas, area, picture, panel);
  }
  return canvas;
}

}  // namespace gvom::snapshot
