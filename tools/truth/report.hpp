// An evaluation as a table for people and as JSON for scripts.
#pragma once

#include <string>

#include "tools/truth/evaluate.hpp"

namespace gvom::truth {

std::string table(const Evaluation& evaluation);

/// Keys are the fields of `Evaluation`; null where nothing was counted.
std::string to_json(const Evaluation& evaluation);

}  // namespace gvom::truth
