// Figures of an earlier run, to see what has become worse.
#pragma once

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/evaluation/figures.hpp"

namespace gvom::evaluation {

struct Baseline {
  std::string settings;
  std::vector<Row> rows;
};

/// Reads what `to_csv` wrote. Errors name the file, the line and the reason.
tl::expected<Baseline, std::string> read_baseline(const std::string& path);

struct Changes {
  std::vector<std::string> worse;  ///< One line each: which figure of which scene, what it was, what it is.
  std::vector<std::string> better;
  int rows_without_baseline = 0;
  int recordings_not_run = 0;  ///< Rows of recordings in the baseline alone: they may be on another machine.
};

/// Compares figures as they are printed. A figure that was measured and is not any more is worse. Rows of the
/// baseline that were not run are passed over.
Changes compare(const Baseline& baseline, const std::vector<Row>& rows);

}  // namespace gvom::evaluation
