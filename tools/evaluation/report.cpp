#include "tools/evaluation/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tools/evaluation/goals.hpp"

namespace gvom::evaluation {
namespace {

using nlohmann::ordered_json;

/// A column of the table, under two lines of words.
struct TableColumn {
  const char* above;
  const char* below;
  Figure figure;
};

constexpr TableColumn kColumns[] = {
    {"NEGATIVE", "near%", Figure::negative_near},
    {"", "30 m%", Figure::negative_30},
    {"", "any%", Figure::negative_any},
    {"HARD", "near%", Figure::hard_near},
    {"", "30 m%", Figure::hard_30},
    {"STEEP", "near%", Figure::steep_near},
    {"", "30 m%", Figure::steep_30},
    {"barred", "15 m%", Figure::path_barred_15},
    {"", "30 m%", Figure::path_barred_30},
    {"hole", "from m", Figure::hole_barred_m},
    {"", "can m", Figure::hole_allowed_m},
    {"lethal", "found%", Figure::lethal_found_near},
    {"p95", "bare m", Figure::bare_p95},
    {"", "veg. m", Figure::vegetation_p95},
    {"", "all m", Figure::height_p95},
    {"trunks", "near%", Figure::trunks_near},
    {"", "30 m%", Figure::trunks_30},
    {"bushes", "SOFT%", Figure::bushes_soft},
    {"", "crown%", Figure::crown_bushes_soft},
    {"HARD", "wall%", Figure::walls_near},
    {"", "car%", Figure::cars_near},
    {"", "rock%", Figure::rocks_near},
    {"grass", "HARD%", Figure::grass_hard},
    {"walker", "found%", Figure::walker_found},
    {"", "p95 s", Figure::trail_p95_s},
    {"known", "near%", Figure::coverage_near},
    {"in", "sight%", Figure::sight_coverage_near},
    {"", "30 m%", Figure::sight_coverage_30},
};

constexpr TableColumn kRealColumns[] = {
    {"NEGATIVE", "near%", Figure::observed_negative_near},
    {"of all", "30 m%", Figure::observed_negative_30},
    {"", "any%", Figure::observed_negative_any},
    {"NEGATIVE", "near%", Figure::negative_near},
    {"", "30 m%", Figure::negative_30},
    {"", "any%", Figure::negative_any},
    {"HARD", "near%", Figure::hard_near},
    {"", "30 m%", Figure::hard_30},
    {"", "any%", Figure::hard_any},
    {"STEEP", "near%", Figure::steep_near},
    {"", "30 m%", Figure::steep_30},
    {"", "any%", Figure::steep_any},
    {"trees", "found%", Figure::real_trees_found},
    {"", "HARD%", Figure::real_trees_hard},
    {"bushes", "soft%", Figure::real_bushes_soft},
};

/// Those of recordings, or those of scenes.
std::vector<Row> select(const std::vector<Row>& rows, bool real) {
  std::vector<Row> selected;
  for (const Row& row : rows)
    if ((row.drive == kRealDrive) == real) selected.push_back(row);
  return selected;
}

template <typename... Values>
void add(std::string& text, const char* format, Values... values) {
  char line[256];
  std::snprintf(line, sizeof line, format, values...);
  text += line;
}

int scene_width(const std::vector<Row>& rows) {
  std::size_t width = 5;
  for (const Row& row : rows) width = std::max(width, row.scene.size());
  return static_cast<int>(width);
}

template <std::size_t kCount>
std::string rows_table(const std::vector<Row>& rows, const TableColumn (&columns)[kCount]) {
  const int width = scene_width(rows);
  std::string text;
  add(text, "%-*s %-7s %-5s", width, "", "", "");
  for (const TableColumn& column : columns) add(text, column.above[0] ? " %8s" : " %6s", column.above);
  add(text, "\n%-*s %-7s %-5s", width, "scene", "sensor", "drive");
  for (const TableColumn& column : columns) add(text, column.above[0] ? " %8s" : " %6s", column.below);
  text += "\n";
  for (const Row& row : rows) {
    add(text, "%-*s %-7s %-5s", width, row.scene.c_str(), row.sensor.c_str(), row.drive.c_str());
    for (const TableColumn& column : columns)
      add(text, column.above[0] ? " %8s" : " %6s",
          text_of(column.figure, row.figures[column.figure]).c_str());
    text += "\n";
  }
  return text;
}

void add_worst(std::string& text, const Goal& goal, const Row* worst) {
  if (worst == nullptr) {
    add(text, "  %8s %-28s", "-", "");
    return;
  }
  const double value = worst->figures[goal.figure];
  add(text, "  %8s%s%-28s", text_of(goal.figure, value).c_str(), reaches(goal, value) ? " " : "*",
      (worst->scene + ", " + worst->sensor).c_str());
}

std::string goals_table(const std::vector<Row>& rows) {
  std::string text;
  add(text, "%-44s %7s  %-37s  %s\n", "goal (* missed)", "", "   trail, worst in", "    fast, worst in");
  for (const Goal& goal : goals()) {
    add(text, "%-44s %7g", goal.title, goal.value);
    add_worst(text, goal, worst_row(goal, rows, "trail"));
    add_worst(text, goal, worst_row(goal, rows, "fast"));
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  }
  return text;
}

std::string real_goals_table(const std::vector<Row>& rows) {
  std::string text;
  add(text, "%-44s %7s     worst in\n", "goal (* missed)", "");
  for (const Goal& goal : real_goals()) {
    add(text, "%-44s %7g", goal.title, goal.value);
    add_worst(text, goal, worst_row(goal, rows, kRealDrive));
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  }
  return text;
}

/// The number that is printed.
ordered_json number(Figure figure, double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(text_of(figure, value).c_str(), nullptr);
}

ordered_json describe_goal(const Goal& goal, const std::vector<Row>& rows) {
  ordered_json described{{"title", goal.title}, {"figure", info_of(goal.figure).key}, {"goal", goal.value}};
  for (const char* drive : {"trail", "fast", kRealDrive}) {
    const Row* worst = worst_row(goal, rows, drive);
    if (worst == nullptr) continue;
    const double value = worst->figures[goal.figure];
    described[drive] = {{"scene", worst->scene},
                        {"sensor", worst->sensor},
                        {"value", number(goal.figure, value)},
                        {"reached", reaches(goal, value)}};
  }
  return described;
}

}  // namespace

std::string table(const std::vector<Row>& rows) {
  const std::vector<Row> scenes = select(rows, false), recordings = select(rows, true);
  std::string text;
  if (!scenes.empty()) text += rows_table(scenes, kColumns) + "\n" + goals_table(scenes);
  if (!scenes.empty() && !recordings.empty()) text += "\n";
  if (!recordings.empty()) text += rows_table(recordings, kRealColumns) + "\n" + real_goals_table(recordings);
  return text;
}

std::string to_csv(const std::vector<Row>& rows, const std::string& settings) {
  std::string text = "# " + settings + "\nscene,sensor,drive";
  for (const FigureInfo& figure : figure_table()) text += std::string(",") + figure.key;
  text += "\n";
  for (const Row& row : rows) {
    text += row.scene + "," + row.sensor + "," + row.drive;
    for (const FigureInfo& info : figure_table()) {
      const double value = row.figures[info.figure];
      text += "," + (std::isnan(value) ? std::string() : text_of(info.figure, value));
    }
    text += "\n";
  }
  return text;
}

std::string to_json(const std::vector<Row>& rows, const std::string& settings) {
  ordered_json json{
      {"settings", settings}, {"rows", ordered_json::array()}, {"goals", ordered_json::array()}};
  for (const Row& row : rows) {
    ordered_json described{{"scene", row.scene}, {"sensor", row.sensor}, {"drive", row.drive}};
    for (const FigureInfo& info : figure_table())
      described[info.key] = number(info.figure, row.figures[info.figure]);
    json["rows"].push_back(described);
  }
  const std::vector<Row> scenes = select(rows, false), recordings = select(rows, true);
  for (const Goal& goal : goals()) json["goals"].push_back(describe_goal(goal, scenes));
  for (const Goal& goal : real_goals()) json["goals"].push_back(describe_goal(goal, recordings));
  return json.dump(1) + "\n";
}

}  // namespace gvom::evaluation
