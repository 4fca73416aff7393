// Which network a source of ROS 2 is on, as its URI says it.
#pragma once

#include <map>
#include <set>
#include <string>

#include <tl/expected.hpp>

#include "services/common/dds/participant.hpp"

namespace gvom::dds {

inline const std::set<std::string> kNetworkOptions = {"config", "distro", "domain", "interface", "peers"};

/// Of a URI's options those that are kNetworkOptions: domain=N (0), interface=NAME, peers=HOST,HOST,
/// distro=humble|jazzy (jazzy), config=FILE. The node is `prefix` and the topic, in one name:
/// "/gvom_ouster_points". Errors name the option, or are domain_xml's.
tl::expected<ParticipantOptions, std::string> network_options(
    const std::map<std::string, std::string>& options, const std::string& prefix, const std::string& topic);

}  // namespace gvom::dds
