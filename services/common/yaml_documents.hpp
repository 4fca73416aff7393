// How many documents a YAML text holds.
#pragma once

#include <string>

namespace gvom::services {

/// 0, 1, or 2 for more: it looks no further, because of some damaged texts yaml-cpp makes documents without
/// end. Throws YAML::Exception.
int count_yaml_documents(const std::string& text);

}  // namespace gvom::services
