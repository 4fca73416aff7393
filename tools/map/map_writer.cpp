#include "tools/map/map_writer.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "tools/snapshot/folder.hpp"

namespace gvom::tools {

using Result = tl::expected<void, std::string>;

tl::expected<MapWriter, std::string> MapWriter::open(const MapWriterOptions& options, OfflineMapper& mapper,
                                                     const services::VehicleConfig& config) {
  MapWriter writer(options, mapper, config.mapper.map.size_xy);
  if (!options.pictures.empty()) {
    auto pictures = snapshot::Output::open({options.pictures, true, false});
    if (!pictures) return tl::unexpected(pictures.error());
    writer.pictures_.emplace(std::move(*pictures));
  }
  if (!options.mcap.empty()) {
    auto mcap = McapOutput::create(options.mcap, config);
    if (!mcap) return tl::unexpected(mcap.error());
    writer.mcap_.emplace(std::move(*mcap));
  }
  return writer;
}

/// Time that goes back (a looped bag) is as good as time that has passed.
Result MapWriter::take(const MappedSweep& sweep) {
  const bool due =
      !written_ns_ || 1e-9 * std::abs(static_cast<double>(sweep.stamp_ns - *written_ns_)) >= options_.every_s;
  waiting_ = sweep;
  return due ? write_waiting() : Result{};
}

Result MapWriter::finish() {
  const Result written = write_waiting();
  const Result closed = mcap_ ? mcap_->close() : Result{};
  return written ? closed : written;
}

Result MapWriter::write_waiting() {
  if (!waiting_) return {};
  const MappedSweep sweep = *waiting_;
  waiting_.reset();
  written_ns_ = sweep.stamp_ns;
  return write(sweep);
}

Result MapWriter::write(const MappedSweep& sweep) {
  if (const auto made = mapper_.make_layers(layers_.arrays()); !made)
    return tl::unexpected(made.error().what);
  Result written;
  if (!options_.out.empty()) written = write_folder(fmt::format("{}/{:06d}", options_.out, maps_), sweep);
  if (written && mcap_) written = mcap_->write(layers_.arrays(), mapper_.fuser());
  if (written) ++maps_;
  return written;
}

Result MapWriter::write_folder(const std::string& folder, const MappedSweep& sweep) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return tl::unexpected(folder + ": " + error.message());
  auto written = layers_.write(folder);
  if (written && options_.voxels) written = write_voxels(folder, mapper_.fuser());
  if (written) written = write_meta(folder, mapper_, sweep);
  if (!written || !pictures_) return written;
  const auto stored = snapshot::read_folder(folder);
  if (!stored) return tl::unexpected(stored.error());
  return pictures_->write(stored->picture);
}

}  // namespace gvom::tools
