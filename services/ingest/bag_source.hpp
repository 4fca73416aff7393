// The topic of a bag as a source of sweeps.
#pragma once

#include <memory>

#include <tl/expected.hpp>

#include "services/ingest/source.hpp"
#include "services/ingest/uri.hpp"

namespace gvom::ingest {

/// `bag:PATH?topic=T`: what more it needs depends on the topic's type: packets of an Ouster `meta`, of a
/// Velodyne `model`, as their pcaps do; clouds nothing. Errors name the bag and what it has instead.
tl::expected<std::unique_ptr<Source>, SourceError> open_bag_source(const SourceUri& uri,
                                                                   const SourceOptions& options);

}  // namespace gvom::ingest
