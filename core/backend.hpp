// What computes the two halves of the pipeline: the CPU or a GPU. For any input both give the same bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/format/brick_map.hpp"
#include "core/format/layers.hpp"
#include "core/returns.hpp"
#include "core/sweep.hpp"
#include "core/window.hpp"

namespace gvom {

/// Which back end is asked for. `automatic`: a GPU if one can be used, else the CPU.
enum class Backend { automatic, cpu, cuda };

/// A device is lost or never came, in the driver's own words. The back end that says so is of no more use:
/// what it held is gone, and all of its calls fail from then on. The CPU's never fail.
struct DeviceError {
  std::string what;
};

template <class T>
using DeviceExpected = tl::expected<T, DeviceError>;

/// How long a device took for one of its steps, by its own clock.
struct KernelTime {
  std::string name;
  double ms = 0;
};

/// Half one for one lidar: the returns of a sweep are counted, then written as a buffer map (R2..R6).
class VoxelizerBackend {
 public:
  virtual ~VoxelizerBackend() = default;

  /// Counts hits and passes of a sweep (R2..R5); returns the room that its map takes. A map that was counted
  /// and not written is forgotten.
  /// @param T_odom_base one pose for each of `sweep.times_ns`
  virtual DeviceExpected<BrickMapShape> count(const Sweep& sweep, const std::vector<Pose>& T_odom_base,
                                              const Grid& grid) = 0;

  /// Writes the counted map (R6); it can be written once.
  /// @param out arrays of at least the counted shape; every element of that shape is written
  virtual DeviceExpected<void> write(const BrickMapArrays& out) = 0;

  /// Of the last counted sweep (R2).
  [[nodiscard]] virtual const FilterCounts& filter_counts() const = 0;
  /// Of each step since the last call; nothing on the CPU, or where they are not timed.
  virtual std::vector<KernelTime> take_kernel_times() { return {}; }
};

/// What a device spent on the last map and the last layers. Times are by the device's own clock.
struct DeviceCosts {
  double upload_ms = 0;
  double fuse_ms = 0;
  double layers_ms = 0;
  double download_ms = 0;
  std::uint64_t launches = 0;  ///< Of kernels, within graphs too.
  std::uint64_t bytes_up = 0;
  std::uint64_t bytes_down = 0;
};

/// Half two for all lidars: buffer maps become the fused map and its layers (R7..R16).
class FusionBackend {
 public:
  virtual ~FusionBackend() = default;

  /// Fuses a map. Its memory must stay until the map is among `window().left()`, also on a device.
  /// A result other than `added` leaves everything as it was; the map is then not kept.
  virtual DeviceExpected<AddResult> add(const WindowMap& map) = 0;

  /// Writes every value of every layer (R9..R16), of the newest map's moment. The window must not be empty.
  virtual DeviceExpected<void> make_layers(const LayerArrays& out) = 0;

  /// The fused voxels as a brick map (R6): the room it takes, then the writing of it.
  virtual DeviceExpected<BrickMapShape> count_voxels() = 0;
  virtual DeviceExpected<void> write_voxels(const BrickMapArrays& out) = 0;

  /// Empties window and map; all maps are then in `window().left()`.
  virtual void reset() = 0;

  [[nodiscard]] virtual const Window& window() const = 0;

  /// Of the last `add` and the last `make_layers`; nothing on the CPU.
  [[nodiscard]] virtual std::optional<DeviceCosts> last_costs() const { return std::nullopt; }
  /// Of each step since the last call; nothing on the CPU, or where they are not timed.
  virtual std::vector<KernelTime> take_kernel_times() { return {}; }
};

}  // namespace gvom
