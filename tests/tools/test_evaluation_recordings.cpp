// What is known of real places, and what recordings of them say of the map.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "tests/support/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/evaluation/baseline.hpp"
#include "tools/evaluation/known_way.hpp"
#include "tools/evaluation/options.hpp"
#include "tools/evaluation/recording_judge.hpp"
#include "tools/evaluation/recording_run.hpp"
#include "tools/evaluation/report.hpp"

using namespace gvom::evaluation;
using gvom::test::TemporaryFolder;

namespace {

constexpr double kEdge_m = 0.4;
constexpr std::uint32_t kNone = 0, kGrass = 3, kTree = 4, kPerson = 17, kBush = 19, kPuddle = 31;

/// Returns of one label in the middle of the column at (x, 0), one above the other.
void add(std::vector<LabelledReturn>& returns, std::uint32_t label, int x, std::vector<double> heights_m) {
  for (const double z : heights_m) returns.push_back({{kEdge_m * (x + 0.5), 0.5 * kEdge_m, z}, label});
}

Known known_at(const std::vector<LabelledReturn>& returns, int x) {
  return know_by_labels(returns, kEdge_m).at({x, 0});
}

tl::expected<std::vector<Row>, std::string> evaluate(const Options& options, std::vector<std::string>& told) {
  const auto plan = make_plan(options);
  REQUIRE(plan);
  return run_recordings(*plan, [&](const std::string& line) { told.push_back(line); });
}

}  // namespace

TEST_CASE("a column is what most of its labelled returns between 0.5 and 2 m above its ground are") {
  std::vector<LabelledReturn> returns;
  add(returns, kGrass, 0, {1.3, 1.0});                // the lower is ground
  add(returns, kTree, 0, {1.4, 1.6, 2.9, 3.1, 5.0});  // 0.6 and 1.9 m above it, else below or over
  add(returns, kBush, 0, {1.2, 1.3, 1.4, 1.7});       // 0.7 m counts
  CHECK(known_at(returns, 0) == Known::tree);
  add(returns, kNone, 0, {1.8, 1.8, 1.8, 1.8});  // nobody's
  CHECK(known_at(returns, 0) == Known::tree);
  add(returns, kBush, 0, {1.8});
  CHECK(known_at(returns, 0) == Known::nothing);  // two of four
  add(returns, kBush, 0, {1.8});
  CHECK(known_at(returns, 0) == Known::bush);
}

TEST_CASE("one return makes no tree, and no ground within 2 m no height") {
  std::vector<LabelledReturn> returns;
  add(returns, kGrass, 0, {0.0});
  add(returns, kTree, 0, {1.0});
  CHECK(known_at(returns, 0) == Known::nothing);
  add(returns, kTree, 5, {1.0, 1.1});
  CHECK(known_at(returns, 5) == Known::tree);  // 2 m away
  add(returns, kTree, 6, {1.0, 1.1});
  CHECK(known_at(returns, 6) == Known::nothing);
}

TEST_CASE("ground beside counts by 1 / distance^2") {
  std::vector<LabelledReturn> returns;
  add(returns, kGrass, 0, {0.0});
  add(returns, kGrass, 3, {0.9});  // at 1 the ground is 0.9 (1/4) / (1 + 1/4) = 0.18 m
  add(returns, kTree, 1, {0.67, 0.67});
  CHECK(known_at(returns, 1) == Known::nothing);
  add(returns, kTree, 1, {0.69, 0.69});
  CHECK(known_at(returns, 1) == Known::tree);
}

TEST_CASE("ground with something on or over it is not known to be drivable, nor is water") {
  std::vector<LabelledReturn> returns;
  for (const int x : {0, 1, 2}) add(returns, kGrass, x, {0.0});
  add(returns, kPerson, 1, {0.2});
  add(returns, kTree, 2, {4.0});
  add(returns, kPuddle, 3, {0.0});
  const KnownColumns known = know_by_labels(returns, kEdge_m);
  CHECK(known.at({0, 0}) == Known::drivable);
  for (const int x : {1, 2, 3}) CHECK(known.at({x, 0}) == Known::nothing);
  CHECK(known.count(Known::drivable) == 1);
}

TEST_CASE("labels are read beside their returns, and refused if they do not fit") {
  const TemporaryFolder folder;
  const std::string scan = folder.path() + "/a.bin", labels = folder.path() + "/a.label";
  const float points[] = {1, 2, 3, 0.5F, 0, 0, 0, 0, 4, 5, 6, 0.5F};
  const std::uint32_t classes[] = {3, 4, 19};
  std::ofstream(scan, std::ios::binary).write(reinterpret_cast<const char*>(points), sizeof points);
  std::ofstream(labels, std::ios::binary).write(reinterpret_cast<const char*>(classes), sizeof classes);
  const auto returns = read_labelled(scan, labels);
  REQUIRE(returns);
  REQUIRE(returns->size() == 2);
  CHECK(returns->at(1).point_m == Eigen::Vector3d(4, 5, 6));
  CHECK(returns->at(1).label == kBush);
  std::filesystem::resize_file(labels, 8);
  CHECK(read_labelled(scan, labels).error() == labels + ": has 2 labels for 3 points");
  std::filesystem::resize_file(labels, 7);
  CHECK(read_labelled(scan, labels).error() == labels + ": is cut off");
  CHECK(read_labelled(scan, labels + "x").error() == labels + "x: cannot be opened");
}

TEST_CASE("a way is drivable to both sides, but for what stands there meanwhile") {
  const Way way_m{{0, 0, 0}, {10, 0, 1}, {10, 10, 1}};
  KnownColumns known = know_by_way(way_m, 2.0, kEdge_m);
  const auto at = [&](double x_m, double y_m) { return known.at(known.voxel_of(x_m, y_m)); };
  CHECK(at(5.0, 1.7) == Known::drivable);  // middles of columns count: here 1.8 m
  CHECK(at(5.0, 2.1) == Known::nothing);
  CHECK(at(8.3, 8.0) == Known::drivable);
  CHECK(at(5.0, 5.0) == Known::nothing);
  CHECK(at(11.0, -1.0) == Known::drivable);  // round the corner

  forget_traffic(known, way_m, {{0.2, 0.2, 0.2}, {9.0, 0.2, 1.2}});  // both 0.2 m above: the road
  CHECK(at(0.2, 0.2) == Known::drivable);
  CHECK(at(9.0, 0.2) == Known::drivable);
  forget_traffic(known, way_m, {{0.2, 0.2, 0.4}, {9.0, 0.2, 5.2}, {9.0, 4.0, 1.5}});
  CHECK(at(0.2, 0.2) == Known::nothing);
  CHECK(at(1.0, 0.2) == Known::nothing);  // 0.8 m beside
  CHECK(at(1.4, 0.2) == Known::drivable);
  CHECK(at(9.0, 0.2) == Known::drivable);  // a bridge
  CHECK(at(9.0, 4.0) == Known::nothing);   // 0.5 m above the nearest point of the way
}

TEST_CASE("shares are of observed columns, and of those of which something is known") {
  KnownColumns known(kEdge_m);
  constexpr int kSize = 128;  // 51 m, the vehicle at the left edge
  std::vector<std::uint8_t> flags(kSize * kSize, 0), visibility(kSize * kSize, 0);
  const auto see = [&](int x, std::uint8_t flag, Known what) {
    flags[x] = flag;
    visibility[x] = static_cast<std::uint8_t>(gvom::Visibility::ground_seen);
    known.set({x, 0}, what);
  };
  using namespace gvom;
  for (const int x : {10, 11, 12}) see(x, 0, Known::drivable);  // near
  see(13, kHard, Known::drivable);
  see(50, kNegative, Known::drivable);  // 20 m
  for (const int x : {14, 15}) see(x, kHard, Known::tree);
  see(16, kSoft, Known::tree);
  see(17, 0, Known::tree);
  see(18, kHard, Known::bush);
  for (const int x : {19, 20, 21}) see(x, x == 19 ? kSoft : 0, Known::bush);
  see(100, kNegative, Known::nothing);  // 40 m
  flags[30] = kNegative;                // not observed
  Frame frame;
  frame.size = kSize;
  frame.flags = flags.data();
  frame.visibility = visibility.data();
  RecordingJudge judge(known);
  judge.add(frame);
  const Figures figures = judge.result();
  CHECK(figures[Figure::observed_negative_near] == 0.0);
  CHECK(figures[Figure::observed_negative_30] == Approx(100.0 / 13));
  CHECK(figures[Figure::observed_negative_any] == Approx(200.0 / 14));
  CHECK(figures[Figure::hard_near] == Approx(25.0));
  CHECK(figures[Figure::hard_30] == Approx(20.0));
  CHECK(figures[Figure::negative_any] == Approx(20.0));
  CHECK(figures[Figure::steep_any] == 0.0);
  CHECK(figures[Figure::real_trees_found] == Approx(75.0));
  CHECK(figures[Figure::real_trees_hard] == Approx(200.0 / 3));
  CHECK(figures[Figure::real_bushes_soft] == Approx(75.0));
}

TEST_CASE("recordings have a block and goals of their own") {
  Row scene{"flat", "os1-64", "trail", {}}, real{"kitti", "hdl-64", kRealDrive, {}};
  scene.figures[Figure::hard_any] = 0.0;
  real.figures[Figure::hard_any] = 1.5;
  real.figures[Figure::observed_negative_30] = 0.22;
  const std::string text = table({scene, real});
  CHECK(text.find("kitti hdl-64  real") > text.find("goal (* missed)"));
  CHECK(text.find("0.22 kitti, hdl-64") != std::string::npos);
  CHECK(text.find("1.500*kitti, hdl-64") != std::string::npos);
  CHECK(table({scene}).find("KITTI") == std::string::npos);
  CHECK(table({real}).find("trunks") == std::string::npos);
  CHECK(to_json({scene, real}, "").find("\"real\"") != std::string::npos);
}

TEST_CASE("recordings of a baseline that are not here are counted, not compared") {
  const Row scene{"flat", "os1-64", "trail", {}}, real{"kitti", "hdl-64", kRealDrive, {}};
  const Baseline baseline{"", {scene, real}};
  CHECK(compare(baseline, {scene}).recordings_not_run == 1);
  CHECK(compare(baseline, {scene}).worse.empty());
  CHECK(compare(baseline, {scene, real}).recordings_not_run == 0);
  CHECK(compare(baseline, {real}).recordings_not_run == 0);  // a scene that was not asked for
}

TEST_CASE("without scenes there must be recordings, and a directory of them") {
  Options options;
  options.scenes = {"none"};
  CHECK_FALSE(make_plan(options));
  options.recordings = "/there/is/none";
  CHECK(make_plan(options).error() == "--recordings /there/is/none: is not a directory");
  const TemporaryFolder folder;
  options.recordings = folder.path();
  REQUIRE(make_plan(options));
  CHECK(make_plan(options)->scenes.empty());
  std::vector<std::string> told;
  const auto rows = evaluate(options, told);
  REQUIRE(rows);
  CHECK(rows->empty());
  REQUIRE(told.size() == 4);
  CHECK(told[0] == "SKIPPED: there is no recording " + folder.path() + "/rellis_offroad");
}

TEST_CASE("real recordings are mapped and judged, the same every time") {
  const auto directory = gvom::test::recordings();
  if (!directory) return;
  const TemporaryFolder folder;
  Options options;
  options.scenes = {"none"};
  options.recordings = *directory;
  options.pictures = folder.path();
  std::vector<std::string> told;
  const auto rows = evaluate(options, told);
  REQUIRE(rows);
  std::vector<std::string> names;
  for (const Row& row : *rows) names.push_back(row.name());
  CHECK(names == std::vector<std::string>{"rellis both real", "rellis os1-64 real", "rellis vlp-32 real",
                                          "kitti hdl-64 real", "woods ouster real", "car os1-128 real"});
  CHECK(rows->at(0).figures[Figure::real_trees_found] > 75.0);  // the returns are there, and 0.5 m up
  CHECK(rows->at(0).figures[Figure::real_bushes_soft] > 75.0);
  CHECK(rows->at(2).figures[Figure::real_trees_found] < rows->at(1).figures[Figure::real_trees_found]);
  CHECK(rows->at(3).figures[Figure::lethal_any] < 50.0);
  for (const Row& row : *rows) CHECK(row.figures[Figure::observed_negative_any] >= 0.0);
  CHECK(std::isnan(rows->at(4).figures[Figure::hard_any]));
  CHECK(std::filesystem::file_size(folder.path() + "/rellis-both.png") > 10'000);
  CHECK(to_csv(evaluate(options, told).value(), "") == to_csv(*rows, ""));
}
