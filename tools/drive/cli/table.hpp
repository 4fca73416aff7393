// Sums over many drives, as text and as Markdown.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/drive/cli/rows_file.hpp"

namespace gvom::driving {

/// Names and values, in order.
using Summary = std::vector<std::pair<std::string, std::string>>;

/// Arrived of those with a way, mishaps by kind, times, speeds, clearances, cycles.
Summary summary_of(const std::vector<Figures>& figures);

/// The same drives as benchmarks of others count them: success, time, tip-over, stuck, roll and pitch.
Summary benchmark_of(const std::vector<Figures>& figures);

/// A line for each.
std::string text_of(const Summary& summary);

/// A row for each campaign, all of the same names.
std::string markdown_of(const std::vector<std::pair<std::string, Summary>>& campaigns);

/// What did not arrive though there is a way, and every mishap: how it ended, and what drives it again.
std::string failures_of(const Rows& rows, const std::string& folder);

}  // namespace gvom::driving
