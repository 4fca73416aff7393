// Figures in tables and files, and what has become worse since a baseline.
#include <cmath>
#include <fstream>
#include <set>

#include <catch2/catch.hpp>

#include "tests/tools/temporary_folder.hpp"
#include "tools/evaluation/baseline.hpp"
#include "tools/evaluation/goals.hpp"
#include "tools/evaluation/report.hpp"

using namespace gvom::evaluation;
using gvom::test::TemporaryFolder;

namespace {

Row make_row(const std::string& scene, const std::string& drive = "trail") {
  Row row{scene, "os1-64", drive, {}};
  row.figures[Figure::negative_near] = 0.12;
  row.figures[Figure::trunks_near] = 98.7;
  row.figures[Figure::bare_p95] = 0.0304;
  return row;
}

Baseline baseline_of(const std::vector<Row>& rows, const TemporaryFolder& folder) {
  const std::string path = folder.path() + "/baseline.csv";
  std::ofstream(path) << to_csv(rows, "seed 1");
  const auto read = read_baseline(path);
  REQUIRE(read);
  return *read;
}

}  // namespace

TEST_CASE("the table of figures is in order, and its keys are unique") {
  std::set<std::string> keys;
  for (std::size_t i = 0; i < kFigures; ++i) {
    CHECK(static_cast<std::size_t>(figure_table()[i].figure) == i);
    CHECK(keys.insert(figure_table()[i].key).second);
  }
}

TEST_CASE("a baseline reads as it was written, up to the printed digits") {
  const TemporaryFolder folder;
  const Baseline baseline = baseline_of({make_row("flat"), make_row("hills")}, folder);
  CHECK(baseline.settings == "seed 1");
  REQUIRE(baseline.rows.size() == 2);
  CHECK(baseline.rows[1].name() == "hills os1-64 trail");
  CHECK(baseline.rows[0].figures[Figure::bare_p95] == 0.030);
  CHECK(std::isnan(baseline.rows[0].figures[Figure::hole_barred_m]));
}

TEST_CASE("what became worse is named, what became better too, and less than a printed digit is neither") {
  const TemporaryFolder folder;
  const Baseline baseline = baseline_of({make_row("flat")}, folder);
  Row row = make_row("flat");
  row.figures[Figure::bare_p95] = 0.0299;
  CHECK(compare(baseline, {row}).worse.empty());
  CHECK(compare(baseline, {row}).better.empty());

  row.figures[Figure::negative_near] = 0.13;
  row.figures[Figure::trunks_near] = 99.0;
  const Changes changes = compare(baseline, {row, make_row("new")});
  CHECK(changes.worse == std::vector<std::string>{"flat os1-64 trail: false NEGATIVE, near: 0.12 -> 0.13 %"});
  CHECK(changes.better == std::vector<std::string>{"flat os1-64 trail: trunks HARD, near: 98.7 -> 99.0 %"});
  CHECK(changes.rows_without_baseline == 1);
}

TEST_CASE("a figure that is not measured any more is worse") {
  const TemporaryFolder folder;
  const Baseline baseline = baseline_of({make_row("flat")}, folder);
  Row row = make_row("flat");
  row.figures[Figure::trunks_near] = std::nan("");
  CHECK(compare(baseline, {row}).worse ==
        std::vector<std::string>{"flat os1-64 trail: trunks HARD, near: 98.7 -> - %"});
}

TEST_CASE("a wrong baseline is refused by file, line and reason") {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/b.csv";
  const auto error_of = [&](const std::string& text) {
    std::ofstream(path) << text;
    return read_baseline(path).error();
  };
  CHECK(error_of("") == path + ": holds no figures");
  CHECK(error_of("a,b\n") == path + ":1: expected \"scene,sensor,drive,\" and keys of figures");
  CHECK(error_of("# x\nscene,sensor,drive,height\n") == path + ":2: there is no figure \"height\"");
  CHECK(error_of("scene,sensor,drive,hard_near\nflat,os1-64,trail\n") == path + ":2: has 3 fields, not 4");
  CHECK(error_of("scene,sensor,drive,hard_near\nflat,os1-64,trail,1x\n") ==
        path + ":2: \"1x\" is not a number");
  CHECK(read_baseline(path + "x").error() == path + "x: cannot be opened");
}

TEST_CASE("a goal is judged by its worst scene, of those that it is about") {
  const Goal negative{"", Figure::negative_near, "-puddles", "", 0.3};
  std::vector<Row> rows{make_row("flat"), make_row("hills"), make_row("puddles"), make_row("flat", "fast")};
  rows[1].figures[Figure::negative_near] = 0.304;
  rows[2].figures[Figure::negative_near] = 9.0;
  rows[3].figures[Figure::negative_near] = 5.0;
  CHECK(worst_row(negative, rows, "trail")->scene == "hills");
  CHECK(worst_row(negative, rows, "fast")->scene == "flat");
  CHECK(reaches(negative, 0.304));  // printed as 0.30
  CHECK_FALSE(reaches(negative, 0.306));
  const Goal two_left_out{"", Figure::negative_near, "-pud,hil", "", 0.3};
  CHECK(worst_row(two_left_out, rows, "trail")->scene == "flat");
  const Goal trunks{"", Figure::trunks_near, "forest,hil", "", 99.0};
  CHECK(worst_row(trunks, rows, "trail")->scene == "hills");
  CHECK_FALSE(reaches(trunks, 98.7));
  const Goal ditch{"", Figure::hole_barred_m, "ditch-2m", "os1-64", 13.0};
  CHECK(worst_row(ditch, rows, "trail") == nullptr);
}

TEST_CASE("the reports name rows, figures and goals") {
  const std::vector<Row> rows{make_row("flat")};
  CHECK(table(rows).find("flat  os1-64  trail") != std::string::npos);
  CHECK(table(rows).find("98.7*flat, os1-64") != std::string::npos);
  CHECK(to_json(rows, "seed 1").find("\"negative_near\": 0.12") != std::string::npos);
  CHECK(to_json(rows, "seed 1").find("\"hole_barred_m\": null") != std::string::npos);
}
