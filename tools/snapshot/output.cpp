#include "tools/snapshot/output.hpp"

#include <cstdio>
#include <filesystem>

#include "tools/snapshot/folder.hpp"
#include "tools/snapshot/render.hpp"

namespace gvom::snapshot {

tl::expected<Output, std::string> Output::open(const OutputOptions& options) {
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) return tl::make_unexpected(options.folder + ": cannot be made: " + error.message());
  return Output(options);
}

tl::expected<void, std::string> Output::write(const LayersPicture& picture) {
  char number[16];
  std::snprintf(number, sizeof number, "%06d", written_);
  const std::string prefix = options_.folder + "/";
  const Canvas montage = render_montage(picture);
  if (options_.numbered) {
    if (auto written = montage.write_png(prefix + number + "-montage.png"); !written) return written;
  }
  if (auto written = montage.write_png(prefix + "montage.png"); !written) return written;

  const auto write_panel = [&](const Panel& panel) {
    return render_layer(picture, panel).write_png(prefix + panel.name + ".png");
  };
  if (auto written = write_panel(make_overview(picture)); !written) return written;
  for (int layer = 0; layer < kLayers; ++layer)
    if (auto written = write_panel(make_panel(static_cast<LayerId>(layer), picture)); !written)
      return written;

  if (auto written = render_ground(picture).write_png(prefix + "ground.png"); !written) return written;

  if (options_.npy) {
    if (auto written = write_folder(prefix + number, picture); !written) return written;
  }
  ++written_;
  return {};
}

}  // namespace gvom::snapshot
