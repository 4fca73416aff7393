#include "services/ingest/make_decoder.hpp"

#include <utility>

#include "services/ingest/ouster_decoder.hpp"
#include "services/ingest/velodyne_calibration.hpp"
#include "services/ingest/velodyne_decoder.hpp"

namespace gvom::ingest {
namespace {

using ModelResult = tl::expected<VelodyneModel, std::string>;

ModelResult velodyne_model(const services::SourceUri& uri) {
  const auto wrong = [&](const std::string& what) {
    return tl::unexpected("source '" + uri.text + "': " + what);
  };
  const auto name = uri.option("model");
  if (!name) return wrong("needs model=M (" + known_velodyne_models() + ")");
  const VelodyneModel* model = find_velodyne_model(*name);
  if (model == nullptr) return wrong("unknown model '" + *name + "' (" + known_velodyne_models() + ")");
  const auto calibration = uri.option("calibration");
  if (model->corrections.empty() && calibration) return wrong("a " + *name + " has no calibration");
  if (model->corrections.empty()) return *model;
  if (!calibration) return wrong("needs calibration=FILE.yaml: each " + *name + " has its own");
  return read_velodyne_calibration(*calibration);
}

}  // namespace

DecoderResult make_ouster_decoder(const services::SourceUri& uri, const SourceOptions& options,
                                  SourceState& state) {
  const auto path = uri.option("meta");
  if (!path) return tl::unexpected("source '" + uri.text + "': needs meta=FILE.json");
  auto metadata = read_ouster_metadata(*path, state.warnings);
  if (!metadata) return tl::unexpected(metadata.error());
  const auto serial = services::number_option(uri, "serial", 0xFF'FFFF'FFFF);
  if (!serial) return tl::unexpected(serial.error());
  if (*serial) metadata->serial = **serial;
  return std::make_unique<OusterDecoder>(std::move(*metadata), options, state);
}

DecoderResult make_velodyne_decoder(const services::SourceUri& uri, const SourceOptions& options,
                                    SourceState& state) {
  auto model = velodyne_model(uri);
  if (!model) return tl::unexpected(model.error());
  VelodyneMarks marks{model->model_byte, model->banks, std::nullopt};
  const auto byte = services::number_option(uri, "model_byte", 0xFF);
  if (!byte) return tl::unexpected(byte.error());
  if (*byte && marks.model_byte) marks.model_byte = static_cast<std::uint8_t>(**byte);
  if (*byte && !marks.model_byte)
    return tl::unexpected("source '" + uri.text + "': model_byte: an HDL-64E sends none");
  if (const auto returns = uri.option("returns")) {
    if (*returns != "single" && *returns != "dual")
      return tl::unexpected("source '" + uri.text + "': returns '" + *returns + "' is not single or dual");
    marks.returns = *returns == "dual" ? VelodyneReturns::dual : VelodyneReturns::single;
  }
  return std::make_unique<VelodyneDecoder>(std::move(*model), marks, options, state);
}

}  // namespace gvom::ingest
