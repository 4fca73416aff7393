// A map that is the truth has no error; a map that is off is off by as much as it is.
#include <cmath>
#include <fstream>

#include <catch2/catch.hpp>

#include "services/common/vehicle_config.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/common/npy.hpp"
#include "tools/sim/scenes/trail.hpp"
#include "tools/sim/simulate.hpp"
#include "tools/truth/report.hpp"

using namespace gvom::truth;
using gvom::test::TemporaryFolder;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kFree = std::numeric_limits<float>::infinity();
constexpr int kSize = 32;

std::size_t at(int x, int y) {
  return static_cast<std::size_t>(y) * kSize + x;
}

/// 32 x 32 columns of 1 m, the ground at 2 m: a tree at (5, 16), a bush at (8, 16), a rock at (10, 12), a
/// ditch along x = 14, a branch over (18, 16) with 2.5 m of clearance, and a person who stands at
/// (20.5, 20.5).
Truth small_truth() {
  Truth truth;
  truth.resolution_m = 1.0;
  truth.size_x = truth.size_y = kSize;
  const std::size_t count = kSize * kSize;
  truth.ground_lowest.assign(count, 2.0F);
  truth.ground_mean.assign(count, 2.1F);
  truth.drop_m.assign(count, 0.0F);
  truth.clearance.assign(count, kFree);
  truth.classes.assign(count, kGround);
  truth.object.assign(count, -1);
  truth.objects = {{"tree", 6.0}, {"bush", 1.0}, {"rock", 1.2}, {"branch", 2.5}};
  const auto put = [&](int x, int y, Class what, int object) {
    truth.classes[at(x, y)] = what;
    truth.object[at(x, y)] = object;
  };
  put(5, 16, kTree, 0);
  put(8, 16, kBush, 1);
  put(10, 12, kRock, 2);
  put(18, 16, kOverhang, 3);
  truth.clearance[at(18, 16)] = 2.5F;
  put(20, 20, kPerson, -1);
  truth.person = {{0.0, 20.5, 20.5}, {10.0, 20.5, 20.5}};
  for (int y = 0; y < kSize; ++y) {
    put(14, y, kDitch, -1);
    truth.drop_m[at(14, y)] = 1.2F;
    truth.ground_lowest[at(14, y)] = 0.8F;
  }
  return truth;
}

/// What a perfect mapper would say, the vehicle at (0, 16).
Frame perfect_map(const Truth& truth) {
  Frame frame;
  frame.info.size = kSize;
  frame.info.resolution_m = 1.0;
  frame.info.base_m = {0.0, 16.0};
  frame.info.stamp_ns = 5'000'000'000;
  frame.height = truth.ground_lowest;
  frame.clearance = truth.clearance;
  frame.flags.assign(kSize * kSize, 0);
  frame.visibility.assign(kSize * kSize, 3);
  for (std::size_t i = 0; i < frame.flags.size(); ++i) {
    if (truth.classes[i] == kTree || truth.classes[i] == kRock || truth.classes[i] == kPerson)
      frame.flags[i] = kHard;
    if (truth.classes[i] == kBush) frame.flags[i] = kSoft;
    if (truth.classes[i] != kDitch) continue;
    frame.flags[i] = kNegative;
    frame.height[i] = kNaN;
    frame.visibility[i] = 1;
  }
  return frame;
}

Evaluation judge(const Truth& truth, const Frame& frame, double within_m = 40.0) {
  Evaluator evaluator(truth, within_m);
  evaluator.add(frame, {1.0, 0.0});
  return evaluator.result();
}

}  // namespace

TEST_CASE("a perfect map has no errors") {
  const Truth truth = small_truth();
  const Evaluation result = judge(truth, perfect_map(truth));
  CHECK(result.height_lowest.count == kSize * kSize - kSize - 5);
  CHECK(result.height_lowest.p95_m == 0.0);
  CHECK(result.height_lowest.bias_m == 0.0);
  CHECK(result.height_mean.bias_m == Approx(-0.1));
  for (const Share& share :
       {result.trees_hard, result.tree_columns_hard, result.bushes_soft, result.tall_rocks_hard,
        result.ditch_negative, result.branch_columns_seen, result.person_flagged})
    CHECK(share.ratio() == 1.0);
  CHECK(result.ditch_negative.of == kSize);
  CHECK(result.branch_clearance.p95_m == 0.0);
  CHECK(result.false_hard.hits == 0);
  CHECK(result.false_negative.hits == 0);
  CHECK(result.false_hard.of > 700);
}

TEST_CASE("a map that is 10 cm too high has that bias, and that error") {
  const Truth truth = small_truth();
  Frame frame = perfect_map(truth);
  for (float& height : frame.height) height += 0.1F;
  const Evaluation result = judge(truth, frame);
  CHECK(result.height_lowest.bias_m == Approx(0.1));
  CHECK(result.height_lowest.median_m == Approx(0.1));
  CHECK(result.height_mean.median_m == Approx(0.0).margin(1e-6));
}

TEST_CASE("a map that is shifted by three columns misses the things and flags plain ground") {
  const Truth truth = small_truth();
  Frame frame = perfect_map(truth);
  frame.info.origin[0] = 3;
  const Evaluation result = judge(truth, frame);
  CHECK(result.trees_hard.ratio() == 0.0);
  CHECK(result.ditch_negative.ratio() == 0.0);
  CHECK(result.false_negative.hits ==
        kSize - 2 - 3);                // all of the ditch but the truth's edge and by the branch
  CHECK(result.false_hard.hits == 1);  // the person; tree and rock fall beside bush and ditch
}

TEST_CASE("assumed ground is not judged as seen") {
  const Truth truth = small_truth();
  Frame frame = perfect_map(truth);
  frame.flags[at(2, 2)] |= kAssumed;
  frame.height[at(2, 2)] = 99.0F;
  CHECK(judge(truth, frame).height_lowest.p95_m == 0.0);
  CHECK(judge(truth, frame).height_lowest.count == kSize * kSize - kSize - 6);
}

TEST_CASE("only what is ahead and within the distance counts as near") {
  const Truth truth = small_truth();
  CHECK(judge(truth, perfect_map(truth), 7.0).trees_hard.of == 1);
  CHECK(judge(truth, perfect_map(truth), 7.0).bushes_soft.of == 0);
  Evaluator behind(truth, 40.0);
  behind.add(perfect_map(truth), {-1.0, 0.0});
  CHECK(behind.result().trees_hard.of == 0);
  CHECK(std::isnan(behind.result().trees_hard.ratio()));
}

TEST_CASE("the simulator's truth and gvom-map's files are read as they are written") {
  const TemporaryFolder folder;
  gvom::sim::RecordingOptions options;
  options.seconds = 0.1;
  options.threads = 2;
  gvom::services::VehicleConfig vehicle;
  vehicle.lidars.resize(1);
  vehicle.lidars[0].name = "top";
  const gvom::sim::World world(gvom::sim::make_trail({1, 1.0, 5.0}));
  REQUIRE(gvom::sim::simulate(vehicle, world, options, folder.path()));
  const auto truth = read_truth(folder.path());
  REQUIRE(truth);
  CHECK(truth->objects.size() > 50);

  // A map of 64 x 64 columns with the true heights.
  const std::string directory = folder.path() + "/map/000000";
  std::filesystem::create_directories(directory);
  std::ofstream(directory + "/meta.json") << R"({"stamp_ns": 1000000000000, "origin": [-20, -20, -32],
    "size": [64, 64, 64], "resolution_m": [0.4, 0.4], "base_position_m": [0, 0, 0]})";
  std::vector<float> height, clearance(64 * 64, kFree);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      height.push_back(
          truth->ground_lowest[(y - 20 - truth->origin[1]) * truth->size_x + x - 20 - truth->origin[0]]);
  const std::vector<std::uint8_t> flags(64 * 64, 0), visibility(64 * 64, 3);
  REQUIRE(gvom::npy::write_npy(directory + "/height.npy", {64, 64}, height.data()));
  REQUIRE(gvom::npy::write_npy(directory + "/clearance.npy", {64, 64}, clearance.data()));
  REQUIRE(gvom::npy::write_npy(directory + "/flags.npy", {64, 64}, flags.data()));
  REQUIRE(gvom::npy::write_npy(directory + "/visibility.npy", {64, 64}, visibility.data()));

  const auto frames = list_frames(folder.path() + "/map");
  REQUIRE(frames);
  const auto frame = read_frame(frames->front());
  REQUIRE(frame);
  const Evaluation result = judge(*truth, *frame, 15.0);
  CHECK(result.height_lowest.count > 2000);
  CHECK(result.height_lowest.p95_m == 0.0);
  CHECK(table(result).find("ground height, against the column's lowest ground") != std::string::npos);
  CHECK(to_json(result).find("\"false_hard\"") != std::string::npos);

  CHECK(list_frames(folder.path()).error() == folder.path() + ": holds no maps (DIR/000000 and so on)");
  std::ofstream(directory + "/meta.json") << "{\"stamp_ns\": 1}";
  CHECK_FALSE(list_frames(folder.path() + "/map"));
  CHECK_FALSE(read_truth(folder.path() + "/map"));
}
