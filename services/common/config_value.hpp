// One value of the configuration: from YAML into its field, and back to text.
#pragma once

#include <string>

#include <yaml-cpp/yaml.h>
#include <tl/expected.hpp>

#include "services/common/config_rows.hpp"

namespace gvom::services {

/// Sets the field, or says what was expected and what was found.
tl::expected<void, std::string> assign(const RowInfo& row, const YAML::Node& node, const Field& field);

/// What a row takes: "a whole number in 8 .. 1024, a multiple of 8".
std::string expected_text(const RowInfo& row, const Field& field);

/// The bounds alone, "8 .. 1024, a multiple of 8", or the words to choose from; empty where there are none.
std::string range_text(const RowInfo& row);

/// YAML that `assign` reads back as the same value; empty for a corner of an absent box.
std::string value_text(const Field& field);

}  // namespace gvom::services
