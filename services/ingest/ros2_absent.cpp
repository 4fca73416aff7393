#include "services/ingest/ros2_source.hpp"

namespace gvom::ingest {

tl::expected<std::unique_ptr<Source>, SourceError> open_ros2_source(const services::SourceUri& uri,
                                                                    const SourceOptions&) {
  return tl::unexpected<SourceError>("source '" + uri.text +
                                     "': this gvom was built without Cyclone DDS (cyclonedds-dev)");
}

}  // namespace gvom::ingest
