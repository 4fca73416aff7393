// What the figures should be, and the worst that they are.
#pragma once

#include <string>
#include <vector>

#include "tools/evaluation/figures.hpp"

namespace gvom::evaluation {

/// A figure that should reach `value` in every scene that it is about.
struct Goal {
  const char* title;
  Figure figure;
  const char* scenes;  ///< Beginnings of their names, with commas; empty: all; "-a,b": all but these.
  const char* sensor;  ///< Empty: all.
  double value;
};

const std::vector<Goal>& goals();
/// Of real recordings.
const std::vector<Goal>& real_goals();

/// The row in which a goal's figure is worst among those of one drive; null if none has it.
const Row* worst_row(const Goal& goal, const std::vector<Row>& rows, const std::string& drive);

/// Whether a figure, as it is printed, is as good as the goal.
bool reaches(const Goal& goal, double value);

}  // namespace gvom::evaluation
