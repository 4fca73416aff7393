#include "tools/truth/report.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

namespace gvom::truth {
namespace {

struct ErrorRow {
  const char* key;
  const char* title;
  ErrorSummary Evaluation::*field;
};

struct ShareRow {
  const char* section;  // starts a new one where it is not null
  const char* key;
  const char* title;
  Share Evaluation::*field;
};

const ErrorRow kErrorRows[] = {
    {"height_lowest", "ground height, against the column's lowest ground", &Evaluation::height_lowest},
    {"height_mean", "ground height, against its mean", &Evaluation::height_mean},
    {"near_height_lowest", "  the same, near, lowest", &Evaluation::near_height_lowest},
    {"near_height_mean", "  the same, near, mean", &Evaluation::near_height_mean},
    {"branch_clearance", "clearance under the branch (R14), near", &Evaluation::branch_clearance},
};

const ShareRow kShareRows[] = {
    {"things, near: flagged in any map", "trees_hard", "trees HARD", &Evaluation::trees_hard},
    {nullptr, "tree_columns_hard", "  columns of trunks HARD", &Evaluation::tree_columns_hard},
    {nullptr, "bushes_soft", "bushes SOFT", &Evaluation::bushes_soft},
    {nullptr, "bushes_obstacle", "bushes SOFT or HARD", &Evaluation::bushes_obstacle},
    {nullptr, "bush_columns_soft", "  columns of bushes SOFT", &Evaluation::bush_columns_soft},
    {nullptr, "bush_columns_obstacle", "  columns of bushes SOFT or HARD",
     &Evaluation::bush_columns_obstacle},
    {nullptr, "tall_rocks_hard", "rocks of 0.9 m and more HARD", &Evaluation::tall_rocks_hard},
    {nullptr, "tall_rocks_obstacle", "rocks of 0.9 m and more HARD or SOFT",
     &Evaluation::tall_rocks_obstacle},
    {nullptr, "low_rocks_obstacle", "lower rocks HARD or SOFT", &Evaluation::low_rocks_obstacle},
    {nullptr, "step_columns_lethal", "columns of the step's face HARD, STEEP or NEGATIVE",
     &Evaluation::step_columns_lethal},
    {"columns of the ditch (0.5 m deep and more), near: in any map", "ditch_negative", "NEGATIVE",
     &Evaluation::ditch_negative},
    {nullptr, "ditch_steep", "STEEP", &Evaluation::ditch_steep},
    {nullptr, "ditch_hard", "HARD", &Evaluation::ditch_hard},
    {nullptr, "ditch_lethal", "any of these", &Evaluation::ditch_lethal},
    {nullptr, "ditch_bottom_seen", "height within 0.3 m of the true one", &Evaluation::ditch_bottom_seen},
    {"plain ground, observed: falsely flagged (map, column)", "near_false_hard", "near, HARD",
     &Evaluation::near_false_hard},
    {nullptr, "near_false_soft", "near, SOFT", &Evaluation::near_false_soft},
    {nullptr, "near_false_negative", "near, NEGATIVE", &Evaluation::near_false_negative},
    {nullptr, "near_false_steep", "near, STEEP", &Evaluation::near_false_steep},
    {nullptr, "false_hard", "anywhere, HARD", &Evaluation::false_hard},
    {nullptr, "false_soft", "anywhere, SOFT", &Evaluation::false_soft},
    {nullptr, "false_negative", "anywhere, NEGATIVE", &Evaluation::false_negative},
    {nullptr, "false_steep", "anywhere, STEEP", &Evaluation::false_steep},
    {"overhead and moving", "branch_columns_seen", "columns under the branch with a clearance, near",
     &Evaluation::branch_columns_seen},
    {nullptr, "person_flagged", "maps with the person near that flag an obstacle there",
     &Evaluation::person_flagged},
    {nullptr, "person_left_behind", "obstacles left where the person is not (map, column)",
     &Evaluation::person_left_behind},
};

template <typename... Values>
void add_line(std::string& text, const char* format, Values... values) {
  char line[200];
  std::snprintf(line, sizeof(line), format, values...);
  text += line;
}

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::string table(const Evaluation& evaluation) {
  std::string text;
  add_line(text, "%zu maps. Near: ahead of the vehicle and within %g m of it.\n\n", evaluation.frames,
           evaluation.within_m);
  add_line(text, "%-52s %10s %8s %8s %8s\n", "error (map - truth), metres", "count", "bias", "median", "p95");
  for (const ErrorRow& row : kErrorRows) {
    const ErrorSummary& error = evaluation.*row.field;
    add_line(text, "%-52s %10zu %+8.3f %8.3f %8.3f\n", row.title, error.count, error.bias_m, error.median_m,
             error.p95_m);
  }
  for (const ShareRow& row : kShareRows) {
    if (row.section != nullptr) add_line(text, "\n%s\n", row.section);
    const Share& share = evaluation.*row.field;
    add_line(text, "  %-50s %7.2f %%  %zu of %zu\n", row.title, 100.0 * share.ratio(), share.hits, share.of);
  }
  text +=
      "\nbias is the mean; median and p95 are of the absolute error. Heights count where ground was seen "
      "(not ASSUMED)\n"
      "and the truth is ground. Plain ground is further than one column from anything else.\n";
  return text;
}

std::string to_json(const Evaluation& evaluation) {
  nlohmann::ordered_json json;
  json["frames"] = evaluation.frames;
  json["within_m"] = evaluation.within_m;
  for (const ErrorRow& row : kErrorRows) {
    const ErrorSummary& error = evaluation.*row.field;
    json[row.key] = {{"count", error.count},
                     {"bias_m", number(error.bias_m)},
                     {"median_m", number(error.median_m)},
                     {"p95_m", number(error.p95_m)}};
  }
  for (const ShareRow& row : kShareRows) {
    const Share& share = evaluation.*row.field;
    json[row.key] = {{"ratio", number(share.ratio())}, {"hits", share.hits}, {"of", share.of}};
  }
  return json.dump(1) + "\n";
}

}  // namespace gvom::truth
