// A bag's facts in words, and the lines of a vehicle's file that would map it.
#pragma once

#include <string>
#include <vector>

#include "tools/ctl/bag_facts.hpp"

namespace gvom::ctl {

/// A table: name, type, messages, rate and span by the recorder, and how late the recorder got them.
std::string bag_table(const BagFacts& facts);

/// What is wrong or odd with its clocks, one line each: lidars against the odometry, times that go back, no
/// odometry, no lidar, clouds without times.
std::vector<std::string> bag_problems(const BagFacts& facts);

/// The name of the file for an Ouster's metadata of this topic: "front_metadata.json".
std::string metadata_file(const BagTopicFacts& topic);

/// YAML for `gvom-map --bag`; what only a person knows is marked by a comment.
std::string vehicle_lines(const BagFacts& facts);

}  // namespace gvom::ctl
