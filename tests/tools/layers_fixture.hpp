// Layers of a small flat world, for the tests of pictures and files.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "tools/snapshot/picture.hpp"

namespace gvom::test {

/// 32 x 32 columns of 0.5 m, column (0, 0) at world voxel (104, -40). Ground at 1 m in the rows y < 24,
/// nothing observed in the others. The vehicle stands at column (8.0, 16.0), looking to +y.
class FlatWorld {
 public:
  static constexpr int kSize = 32;
  static constexpr double kResolution_m = 0.5;

  FlatWorld() {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    floats.assign(kFloatLayers, std::vector<float>(kSize * kSize, nan));
    bytes.assign(3, std::vector<std::uint8_t>(kSize * kSize, 0));
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) fill_column(x, y, y < 24);
  }

  std::vector<float>& layer_f(LayerId id) { return floats[static_cast<std::size_t>(id)]; }
  std::vector<std::uint8_t>& layer_u8(LayerId id) {
    return bytes[static_cast<std::size_t>(id) - kFloatLayers];
  }
  static std::size_t at(int x, int y) { return static_cast<std::size_t>(y * kSize + x); }

  void make_hard(int x, int y) {
    layer_f(LayerId::obstacle_density)[at(x, y)] = 1.0F;
    layer_u8(LayerId::flags)[at(x, y)] = kHard;
    layer_u8(LayerId::cost)[at(x, y)] = 254;
  }

  /// Valid while this lives.
  [[nodiscard]] snapshot::LayersPicture picture() const {
    snapshot::LayersPicture p;
    p.vehicle = "flat";
    p.n_xy = kSize;
    p.n_z = 16;
    p.origin_voxels = {104, -40, -8};
    p.resolution_xy_m = p.resolution_z_m = kResolution_m;
    p.base_position_m = {(104 + 8) * kResolution_m, (-40 + 16) * kResolution_m, 1.0};
    p.base_orientation_xyzw = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};
    p.stamp_ns = 1'317'046'450'123'456'789;
    p.maps_in_window = 3;
    p.lidars.push_back({"front", 3, false, 0.0, 0});
    p.lidars.push_back({"rear", 0, true, std::nan(""), 0});
    for (std::size_t i = 0; i < floats.size(); ++i) p.float_layers[i] = floats[i].data();
    for (std::size_t i = 0; i < bytes.size(); ++i) p.byte_layers[i] = bytes[i].data();
    return p;
  }

  std::vector<std::vector<float>> floats;
  std::vector<std::vector<std::uint8_t>> bytes;

 private:
  void fill_column(int x, int y, bool seen) {
    layer_u8(LayerId::cost)[at(x, y)] = seen ? 0 : 255;
    layer_u8(LayerId::visibility)[at(x, y)] = seen ? 3 : 0;
    if (!seen) return;
    layer_f(LayerId::height)[at(x, y)] = 1.0F;
    for (const LayerId zero : {LayerId::slope_x, LayerId::slope_y, LayerId::slope, LayerId::roughness,
                               LayerId::obstacle_density, LayerId::negative_delta, LayerId::last_seen})
      layer_f(zero)[at(x, y)] = 0.0F;
    layer_f(LayerId::clearance)[at(x, y)] = std::numeric_limits<float>::infinity();
  }
};

}  // namespace gvom::test
