// Rows of a campaign: what a table says of them, and a file that goes on where it was cut.
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "tests/tools/temporary_folder.hpp"
#include "tools/drive/cli/table.hpp"

using namespace gvom;
using namespace gvom::driving;
using namespace gvom::test;

namespace {

const Making kMaking{"--config a.yaml --length 60", "0123456789abcdef"};

Figures arrived(std::uint64_t seed, double seconds, double way_s = 10) {
  Figures figures;
  figures.seed = seed;
  figures.world = "campaign-" + std::to_string(seed);
  figures.outcome = words_of(Outcome::arrived);
  figures.way_s = way_s;
  figures.seconds = seconds;
  figures.driven_m = 60;
  figures.top_mps = 4.5;
  figures.nearest_m = 0.5;
  figures.end = "arrived: 0.1 m from the last waypoint, at last";
  return figures;
}

Figures failed(std::uint64_t seed, Outcome outcome, const std::string& mishap = "") {
  Figures figures = arrived(seed, 30);
  figures.outcome = words_of(outcome);
  figures.mishap = mishap;
  figures.end = mishap.empty() ? "gave up" : mishap + " 7 at (1.0, 2.0) m";
  return figures;
}

std::string value_of(const Summary& summary, const std::string& name) {
  for (const auto& [known, value] : summary)
    if (known == name) return value;
  return "no " + name;
}

/// Six worlds: two arrive, one of them in three times the time; two hit, one tips over, one stands.
std::vector<Figures> six() {
  Figures stood = failed(6, Outcome::gave_up);
  stood.false_stops = 2;
  return {arrived(1, 12),
          arrived(2, 30),
          failed(3, Outcome::mishap, "hit person"),
          failed(4, Outcome::mishap, "hit rock"),
          failed(5, Outcome::mishap, "tipped over"),
          stood};
}

}  // namespace

TEST_CASE("a table counts what came of the worlds") {
  const Summary summary = summary_of(six());
  CHECK(value_of(summary, "worlds") == "6");
  CHECK(value_of(summary, "of these arrived") == "2, 33.3 %");
  CHECK(value_of(summary, "hit") == "2: person 1, rock 1");
  CHECK(value_of(summary, "tipped over") == "1");
  CHECK(value_of(summary, "fell") == "0");
  CHECK(value_of(summary, "stuck, though there was a way") == "1");
  CHECK(value_of(summary, "false stops") == "2");
  CHECK(value_of(summary, "time over the truth planner's: p50, p90, max") == "3.00, 3.00, 3.00");
  const Summary benchmark = benchmark_of(six());
  CHECK(value_of(benchmark, "success rate") == "33.3 %");
  CHECK(value_of(benchmark, "mean time to goal (s)") == "21.0");
  CHECK(value_of(benchmark, "tip-over rate") == "16.7 %");
  CHECK(value_of(benchmark, "stuck rate, high-centred or standing") == "16.7 %");
  CHECK(value_of(benchmark, "other mishaps") == "33.3 %");
}

TEST_CASE("a world without a way is none that it is stuck in") {
  Figures walled = failed(1, Outcome::gave_up);
  walled.way_s.reset();
  const Summary summary = summary_of({walled, arrived(2, 12)});
  CHECK(value_of(summary, "with a way") == "1");
  CHECK(value_of(summary, "of these arrived") == "1, 100.0 %");
  CHECK(value_of(summary, "stuck, though there was a way") == "0");
}

TEST_CASE("failures are listed with what drives them again") {
  const std::string text = failures_of({kMaking, six()}, "/logs");
  CHECK(text.find("seed 1:") == std::string::npos);
  CHECK(text.find("seed 6: gave up\n  log: /logs/campaign-6-6.csv\n") != std::string::npos);
  CHECK(text.find("gvom-drive --config a.yaml --length 60 --seeds 4 --out again --strip all --mcap\n") !=
        std::string::npos);
}

TEST_CASE("a line is read back as it was written, with commas in its end and without a way") {
  Figures figures = failed(3, Outcome::mishap, "hit rock");
  figures.way_s.reset();
  const std::string line = line_of(figures);
  const auto back = read_figures(line);
  REQUIRE(back);
  CHECK(line_of(*back) == line);
  CHECK_FALSE(back->way_s);
  CHECK(back->end == "hit rock 7 at (1.0, 2.0) m");
  for (const char* wrong : {"", "7,w,arrived", "x,w,arrived,,1,1,1,1,1,1,1,1,1,1,e"})
    CHECK_FALSE(read_figures(wrong));
}

TEST_CASE("a file of rows goes on, forgets a line that was cut, and refuses another making") {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/a/rows.csv";
  {
    auto file = RowsFile::open(path, kMaking);
    REQUIRE(file);
    CHECK(file->append(arrived(4, 12)));
    CHECK(file->append(arrived(9, 13)));
  }
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 5);
  {
    auto file = RowsFile::open(path, kMaking);
    REQUIRE(file);
    CHECK(file->seeds() == std::set<std::uint64_t>{4});
    CHECK(file->append(arrived(9, 14)));
  }
  const auto rows = read_rows(path);
  REQUIRE(rows);
  REQUIRE(rows->figures.size() == 2);
  CHECK(rows->making == kMaking);
  CHECK(rows->figures[1].seconds == 14);
  CHECK_FALSE(RowsFile::open(path, {kMaking.options, "another file"}));
  CHECK_FALSE(RowsFile::open(path, {kMaking.options + " --ablation one-lidar", kMaking.vehicle}));
  std::ofstream(folder.path() + "/other.csv") << "x\n";
  CHECK_FALSE(RowsFile::open(folder.path() + "/other.csv", kMaking));
  CHECK_FALSE(RowsFile::open(folder.path() + "/other.csv/rows.csv", kMaking));
}

TEST_CASE("the hash of a vehicle's file is FNV-1a") {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/a";
  std::ofstream(path) << "a";
  CHECK(hash_of_file(path) == "af63dc4c8601ec8c");
}
