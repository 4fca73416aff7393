// What gvom-map leaves of a run: folders of arrays, pictures of them, an MCAP file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "tools/map/mcap_output.hpp"
#include "tools/map/offline.hpp"
#include "tools/map/output.hpp"
#include "tools/snapshot/output.hpp"

namespace gvom::tools {

struct MapWriterOptions {
  std::string out;      ///< Folder for the maps, 000000 and up; empty: none.
  bool voxels = false;  ///< The fused voxels too.
  double every_s = 0;   ///< At most one map in so many seconds of the recording; 0: one of each sweep.
  std::string
      pictures;  ///< Folder for a montage of each map and pictures of the newest; empty: none. Needs `out`.
  std::string mcap;  ///< File of the maps as gvom-bridge's messages; empty: none.
};

class MapWriter {
 public:
  /// `mapper` outlives the writer. Errors name the folder or the file that can't be made, or the key that is
  /// wrong.
  static tl::expected<MapWriter, std::string> open(const MapWriterOptions& options, OfflineMapper& mapper,
                                                   const services::VehicleConfig& config);

  /// After each sweep that was mapped: writes a map if one is due. Errors name the file.
  tl::expected<void, std::string> take(const MappedSweep& sweep);
  /// At the end: the newest sweep's map, if that was not due, and the MCAP file's summary.
  tl::expected<void, std::string> finish();

  [[nodiscard]] int maps() const { return maps_; }

 private:
  MapWriter(const MapWriterOptions& options, OfflineMapper& mapper, int size_xy)
      : options_(options), mapper_(mapper), layers_(size_xy) {}
  tl::expected<void, std::string> write_waiting();
  tl::expected<void, std::string> write(const MappedSweep& sweep);
  tl::expected<void, std::string> write_folder(const std::string& folder, const MappedSweep& sweep);

  MapWriterOptions options_;
  OfflineMapper& mapper_;
  LayerBuffers layers_;
  std::optional<snapshot::Output> pictures_;
  std::optional<McapOutput> mcap_;
  std::optional<std::int64_t> written_ns_;  // stamp of the newest map's sweep
  std::optional<MappedSweep> waiting_;
  int maps_ = 0;
};

}  // namespace gvom::tools
