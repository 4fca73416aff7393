// What a table says of one drive, and as a line of a file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "tools/drive/cli/session.hpp"

namespace gvom::driving {

struct Figures {
  std::uint64_t seed = 0;
  std::string world;
  std::string outcome;          ///< Of `words_of(Outcome)`.
  std::string mishap;           ///< "hit person", "fell"; empty: none.
  std::optional<double> way_s;  ///< Of one who knows the world; nothing: there is no way.
  double seconds = 0;
  double driven_m = 0;
  double top_mps = 0;
  double nearest_m = 0;
  int false_stops = 0;
  double roll_rad = 0;  ///< Mean of its size over the drive, as of the pitch.
  double pitch_rad = 0;
  double cycle_p50_ms = 0;  ///< Of the planner.
  double cycle_p99_ms = 0;
  std::string end;  ///< In words.

  [[nodiscard]] bool arrived() const { return outcome == words_of(Outcome::arrived); }
  /// It stands somewhere without a mishap though there is a way.
  [[nodiscard]] bool is_stuck() const { return way_s && !arrived() && mishap.empty(); }
};

/// The value below which a share of the values lies, 0 .. 1; NaN of none.
double quantile(std::vector<double> values, double share);

Figures figures_of(const std::string& world, std::uint64_t seed, const SessionResult& result);

/// Names of the fields of a line, like it separated by commas.
extern const char* const kFigureNames;
std::string line_of(const Figures& figures);
/// The error says what was expected.
tl::expected<Figures, std::string> read_figures(const std::string& line);

}  // namespace gvom::driving
