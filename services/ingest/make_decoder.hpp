// The decoder that a source's URI asks for.
#pragma once

#include <memory>
#include <set>
#include <string>

#include <tl/expected.hpp>

#include "services/common/source_uri.hpp"
#include "services/ingest/decoder.hpp"
#include "services/ingest/source.hpp"

namespace gvom::ingest {

using DecoderResult = tl::expected<std::unique_ptr<Decoder>, std::string>;

/// The options that the two below read.
inline const std::set<std::string> kOusterOptions = {"meta", "serial"};
inline const std::set<std::string> kVelodyneOptions = {"calibration", "model", "model_byte", "returns"};

/// By the options `meta` (a metadata file) and `serial`. The decoder reports to `state`, which outlives it.
/// Errors name the source and the option, or the file.
DecoderResult make_ouster_decoder(const services::SourceUri& uri, const SourceOptions& options,
                                  SourceState& state);

/// By `model`, `calibration`, `model_byte`, `returns`; else as above.
DecoderResult make_velodyne_decoder(const services::SourceUri& uri, const SourceOptions& options,
                                    SourceState& state);

}  // namespace gvom::ingest
