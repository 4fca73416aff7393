// Real recordings, mapped and judged.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/evaluation/figures.hpp"
#include "tools/evaluation/run.hpp"

namespace gvom::evaluation {

/// Takes a line for people.
using Tell = std::function<void(const std::string& line)>;

/// A row for each recording of the plan's directory; none without one. Judged is every map from the one that
/// fills the window on; of a shorter recording the last. What is not there is told, as skipped. Errors name
/// recording and reason.
tl::expected<std::vector<Row>, std::string> run_recordings(const Plan& plan, const Tell& tell);

}  // namespace gvom::evaluation
