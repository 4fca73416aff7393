// A topic of ROS 2 as a live source of sweeps.
#pragma once

#include <memory>

#include <tl/expected.hpp>

#include "services/common/source_uri.hpp"
#include "services/ingest/source.hpp"

namespace gvom::ingest {

/// `ros2:/TOPIC`: with `meta` an Ouster's packets, with `model` a Velodyne's, else clouds;
/// dds::kNetworkOptions say on which network. Errors: options, names; a network that is not there
/// (unavailable); a gvom that was built without Cyclone DDS. A topic that nobody publishes is none: its
/// source is silent.
tl::expected<std::unique_ptr<Source>, SourceError> open_ros2_source(const services::SourceUri& uri,
                                                                    const SourceOptions& options);

}  // namespace gvom::ingest
