#include "tests/ctl/exposition_reader.hpp"

#include <regex>
#include <sstream>
#include <stdexcept>

namespace gvom::test {

namespace {

using Families = std::map<std::string, MetricFamily>;

void require(bool good, const std::string& line) {
  if (!good) throw std::runtime_error("not Prometheus's format: " + line);
}

/// "# HELP NAME TEXT" or "# TYPE NAME WORD".
void read_comment(const std::string& line, Families& families, std::string& current) {
  static const std::regex form("# (HELP|TYPE) ([a-zA-Z_:][a-zA-Z0-9_:]*) (.+)");
  std::smatch parts;
  require(std::regex_match(line, parts, form), line);
  const std::string name = parts[2];
  if (parts[1] == "HELP") {
    require(families.count(name) == 0, line);
    current = name;
    families[name].help = parts[3];
    return;
  }
  require(name == current && families[name].type.empty() && families[name].samples.empty(), line);
  families[name].type = parts[3];
  const bool is_total = name.size() > 6 && name.compare(name.size() - 6, 6, "_total") == 0;
  require(parts[3] == (is_total ? "counter" : "gauge"), line);
}

void read_sample(const std::string& line, Families& families, const std::string& current) {
  static const std::regex form(
      R"re(([a-zA-Z_:][a-zA-Z0-9_:]*)(\{[a-zA-Z_][a-zA-Z0-9_]*="(?:[^"\\]|\\["\\n])*")re"
      R"re((?:,[a-zA-Z_][a-zA-Z0-9_]*="(?:[^"\\]|\\["\\n])*")*\})? (\S+))re");
  std::smatch parts;
  require(std::regex_match(line, parts, form) && parts[1] == current, line);
  MetricFamily& family = families.at(current);
  require(!family.type.empty(), line);
  std::size_t used = 0;
  const std::string number = parts[3];
  const double value = std::stod(number, &used);
  require(used == number.size() && family.samples.emplace(parts[2], value).second, line);
}

}  // namespace

std::map<std::string, MetricFamily> read_exposition(const std::string& text) {
  require(!text.empty() && text.back() == '\n', "no line end at the end");
  Families families;
  std::string current;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.front() == '#')
      read_comment(line, families, current);
    else
      read_sample(line, families, current);
  }
  return families;
}

}  // namespace gvom::test
