#include "core/mapper.hpp"
#include "tools/benchmark/measure.hpp"

namespace gvom::bench {

namespace {

constexpr std::int64_t kTick_ns = 100'000'000;

// Memory for all layers.
class OwnedLayers {
 public:
  explicit OwnedLayers(std::size_t columns) : floats_(10 * columns), bytes_(3 * columns) {
    float* f = floats_.data();
    std::uint8_t* b = bytes_.data();
    arrays_ = {f,
               f + columns,
               f + 2 * columns,
               f + 3 * columns,
               f + 4 * columns,
               f + 5 * columns,
               f + 6 * columns,
               f + 7 * columns,
               f + 8 * columns,
               f + 9 * columns,
               b,
               b + columns,
               b + 2 * columns};
  }
  [[nodiscard]] const LayerArrays& arrays() const { return arrays_; }

 private:
  std::vector<float> floats_;
  std::vector<std::uint8_t> bytes_;
  LayerArrays arrays_{};
};

// Copies a map, for the ring of those that are in the window; memory is used again.
void copy(const OwnedMap& from, std::int64_t stamp_ns, OwnedMap& to) {
  to.directory = from.directory;
  to.lookup = from.lookup;
  to.columns = from.columns;
  to.records = from.records;
  to.view = {from.view.grid,      stamp_ns,         from.view.T_odom_base, from.view.shape,
             to.directory.data(), to.lookup.data(), to.columns.data(),     to.records.data()};
}

}  // namespace

FusionTimes measure_fusion(const Recording& recording, const std::vector<OwnedMap>& maps, int window,
                           int ticks) {
  MapperConfig config;
  config.window.buffer_size = window;
  config.window.max_age_s = 3600;
  MapFuser fuser(config);
  const auto n_xy = static_cast<std::size_t>(config.map.size_xy);
  const OwnedLayers layers(n_xy * n_xy);
  std::vector<OwnedMap> ring(static_cast<std::size_t>(window) + 1);
  FusionTimes times;
  times.window = window;
  for (int tick = 0; tick < window + ticks; ++tick) {
    const auto k = static_cast<std::size_t>(tick);
    OwnedMap& map = ring[k % ring.size()];
    copy(maps[recording.sweep_of_tick(k)], tick * kTick_ns, map);
    const double fuse_ms = time_ms([&] { fuser.add({map.view, 0, k}); });
    const double layers_ms = time_ms([&] { fuser.make_layers(layers.arrays()); });
    if (tick < window) continue;  // not full yet: nothing leaves
    times.fuse.add(fuse_ms);
    times.layers.add(layers_ms);
    times.both.add(fuse_ms + layers_ms);
  }
  return times;
}

}  // namespace gvom::bench
