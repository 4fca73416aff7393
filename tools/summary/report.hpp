// A run's record for people and for scripts.
#pragma once

#include <string>

#include "tools/summary/run_record.hpp"

namespace gvom::summary {

/// One line: how far the run is.
std::string progress_line(const RunRecord& record);

/// The tables.
std::string report(const RunRecord& record);

/// The same figures as JSON, with every counter by its own name.
std::string to_json(const RunRecord& record);

}  // namespace gvom::summary
