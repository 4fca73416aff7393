// The topic of a bag as a source of sweeps.
#pragma once

#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "services/common/source_uri.hpp"
#include "services/ingest/packet.hpp"
#include "services/ingest/source.hpp"

namespace gvom::ingest {

/// `bag:PATH?topic=T`: what more it needs depends on the topic's type: packets of an Ouster `meta`, of a
/// Velodyne `model`, as their pcaps do; clouds nothing. Errors name the bag and what it has instead.
tl::expected<std::unique_ptr<Source>, SourceError> open_bag_source(const services::SourceUri& uri,
                                                                   const SourceOptions& options);

/// The packets of a `bag:PATH?topic=T` whose topic has packets, as they were sent; no ports are known.
/// `state` outlives them.
tl::expected<std::unique_ptr<PacketSource>, std::string> open_bag_packets(const std::string& uri,
                                                                          SourceState& state);

}  // namespace gvom::ingest
