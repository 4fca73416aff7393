#include "tools/evaluation/baseline.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

namespace gvom::evaluation {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == ',')
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

tl::expected<double, std::string> parse_value(const std::string& text) {
  if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (*end != '\0') return tl::unexpected("\"" + text + "\" is not a number");
  return value;
}

/// Which figure each field after the third is of.
tl::expected<std::vector<Figure>, std::string> parse_keys(const std::string& line) {
  const std::vector<std::string> keys = split(line);
  if (keys.size() < 4 || keys[0] != "scene" || keys[1] != "sensor" || keys[2] != "drive")
    return tl::unexpected(std::string("expected \"scene,sensor,drive,\" and keys of figures"));
  std::vector<Figure> figures;
  for (std::size_t i = 3; i < keys.size(); ++i) {
    const auto& all = figure_table();
    const auto info =
        std::find_if(all.begin(), all.end(), [&](const FigureInfo& f) { return keys[i] == f.key; });
    if (info == all.end()) return tl::unexpected("there is no figure \"" + keys[i] + "\"");
    figures.push_back(info->figure);
  }
  return figures;
}

tl::expected<Row, std::string> parse_row(const std::string& line, const std::vector<Figure>& figures) {
  const std::vector<std::string> fields = split(line);
  if (fields.size() != figures.size() + 3)
    return tl::unexpected("has " + std::to_string(fields.size()) + " fields, not " +
                          std::to_string(figures.size() + 3));
  Row row{fields[0], fields[1], fields[2], {}};
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const auto value = parse_value(fields[i + 3]);
    if (!value) return tl::unexpected(value.error());
    row.figures[figures[i]] = *value;
  }
  return row;
}

double printed(Figure figure, double value) {
  return std::isnan(value) ? value : std::strtod(text_of(figure, value).c_str(), nullptr);
}

void compare_figure(const FigureInfo& info, const Row& before, const Row& now, Changes& changes) {
  if (info.better == Better::neither) return;
  const double was = before.figures[info.figure];
  const double is = printed(info.figure, now.figures[info.figure]);
  if (std::isnan(was) || was == is) return;
  const bool better = info.better == Better::lower ? is < was : is > was;
  const std::string unit = info.unit[0] == '\0' ? "" : std::string(" ") + info.unit;
  (better ? changes.better : changes.worse)
      .push_back(now.name() + ": " + info.title + ": " + text_of(info.figure, was) + " -> " +
                 text_of(info.figure, is) + unit);
}

std::vector<Row>::const_iterator find(const std::vector<Row>& rows, const Row& wanted) {
  return std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.name() == wanted.name(); });
}

}  // namespace

tl::expected<Baseline, std::string> read_baseline(const std::string& path) {
  std::ifstream file(path);
  if (!file) return tl::unexpected(path + ": cannot be opened");
  Baseline baseline;
  std::vector<Figure> figures;
  int number = 0;
  const auto wrong = [&](const std::string& reason) {
    return tl::unexpected(path + ":" + std::to_string(number) + ": " + reason);
  };
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.compare(0, 2, "# ") == 0) {
      baseline.settings = line.substr(2);
    } else if (figures.empty()) {
      auto keys = parse_keys(line);
      if (!keys) return wrong(keys.error());
      figures = std::move(*keys);
    } else {
      auto row = parse_row(line, figures);
      if (!row) return wrong(row.error());
      baseline.rows.push_back(std::move(*row));
    }
  }
  if (baseline.rows.empty()) return tl::unexpected(path + ": holds no figures");
  return baseline;
}

Changes compare(const Baseline& baseline, const std::vector<Row>& rows) {
  Changes changes;
  for (const Row& before : baseline.rows)
    changes.recordings_not_run += before.drive == kRealDrive && find(rows, before) == rows.end();
  for (const Row& row : rows) {
    const auto before = find(baseline.rows, row);
    if (before == baseline.rows.end()) {
      ++changes.rows_without_baseline;
      continue;
    }
    for (const FigureInfo& info : figure_table()) compare_figure(info, *before, row, changes);
  }
  return changes;
}

}  // namespace gvom::evaluation
