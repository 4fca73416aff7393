// The figures as a table for people, as CSV and as JSON.
#pragma once

#include <string>
#include <vector>

#include "tools/evaluation/figures.hpp"

namespace gvom::evaluation {

/// One line a row with the figures that say most, then the goals, each with its worst scene; then the same of
/// recordings.
std::string table(const std::vector<Row>& rows);

/// All figures, one line a row under a line of keys, empty where there was nothing to measure; before them a
/// line "# SETTINGS".
std::string to_csv(const std::vector<Row>& rows, const std::string& settings);

/// {"settings", "rows", "goals"}; null where there was nothing to measure.
std::string to_json(const std::vector<Row>& rows, const std::string& settings);

}  // namespace gvom::evaluation
