// Odometry out of bags: topics and tf, with the messages' own stamps.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "services/common/odometry_file.hpp"
#include "tests/support/mcap_builder.hpp"
#include "tests/support/ros_messages.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using Catch::Contains;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kLate_ns = 500 * kSecond_ns;  // the recorder's clock is another
const std::string kOdometryType = "nav_msgs/msg/Odometry";
const std::string kTfType = "tf2_msgs/msg/TFMessage";

class Bag {
 public:
  std::uint16_t topic(const std::string& name, const std::string& type) { return file_.topic(name, type); }
  void add(std::uint16_t topic, const Octets& message) { file_.add(topic, kLate_ns + ++messages_, message); }

  tl::expected<std::vector<StampedPose>, std::string> read(const std::string& options) {
    file_.write(path());
    warnings.clear();
    return services::read_odometry_source("bag:" + path() + options, warnings);
  }
  std::vector<StampedPose> poses(const std::string& options) {
    auto read_poses = read(options);
    INFO((read_poses ? "" : read_poses.error()));
    REQUIRE(read_poses.has_value());
    return std::move(*read_poses);
  }
  [[nodiscard]] std::string path() const { return folder_.path() + "/a.mcap"; }

  std::vector<std::string> warnings;

 private:
  TemporaryFolder folder_;
  McapBuilder file_;
  std::int64_t messages_ = 0;
};

const std::array<double, 4> kQuarterTurn{0, 0, std::sqrt(0.5), std::sqrt(0.5)};  // to the left

}  // namespace

TEST_CASE("an odometry topic: poses at the messages' own stamps") {
  Bag bag;
  const auto topic = bag.topic("/odom", kOdometryType);
  for (int i = 0; i < 3; ++i) bag.add(topic, odometry_message(i * kSecond_ns / 10, 2.0 * i));
  const auto poses = bag.poses("?topic=/odom");
  REQUIRE(poses.size() == 3);
  CHECK(poses[2].stamp_ns == kSecond_ns / 5);
  CHECK(poses[2].T_odom_base.translation_m == Eigen::Vector3d(4, 0, 0));
  CHECK(poses[2].T_odom_base.rotation.w() == 1);
  CHECK(bag.warnings.empty());
}

TEST_CASE("what is no pose, of another frame or not newer is left out, counted and named") {
  Bag bag;
  const auto topic = bag.topic("/odom", kOdometryType);
  for (int round = 0; round < 2; ++round)  // looped
    for (int i = 1; i < 4; ++i) bag.add(topic, odometry_message(i * kSecond_ns, i));
  bag.add(topic, odometry_message(5 * kSecond_ns, std::numeric_limits<double>::quiet_NaN()));
  bag.add(topic, odometry_message(6 * kSecond_ns, 6, "camera"));
  bag.add(topic, {0, 1, 0, 0, 1});
  bag.add(topic, odometry_message(7 * kSecond_ns, 7));
  const auto poses = bag.poses("?topic=/odom");
  REQUIRE(poses.size() == 4);
  CHECK(poses.back().stamp_ns == 7 * kSecond_ns);
  const std::string name = bag.path() + " /odom: left out ";
  CHECK(bag.warnings ==
        std::vector<std::string>{
            name + "2 poses; the first: message 7: expected a finite position",
            name + "1 pose of another frame; the first: message 8: camera, not base_link",
            name + "3 poses that do not go on in time (a looped bag?); the first: message 4: 1 s after 3 s"});
}

TEST_CASE("a few poses far ahead of those that follow do not cost these") {
  Bag bag;
  const auto topic = bag.topic("/odom", kOdometryType);
  for (int i = 1; i < 9; ++i) {
    const bool ahead = i == 3 || i == 4;
    bag.add(topic, odometry_message((i + (ahead ? 3600 : 0)) * kSecond_ns, i));
  }
  const auto poses = bag.poses("?topic=/odom");
  REQUIRE(poses.size() == 6);
  CHECK(poses[2].stamp_ns == 5 * kSecond_ns);
  CHECK(bag.warnings ==
        std::vector<std::string>{bag.path() + " /odom: left out 2 poses far ahead of those that follow; the "
                                              "first: message 5: 5 s after 3604 s"});
}

TEST_CASE("tf: the moving link, with those that stand still before and behind it") {
  Bag bag;
  const auto tf = bag.topic("/tf", kTfType);
  const auto standing = bag.topic("/tf_static", kTfType);
  bag.add(standing, tf_message({{"base_footprint", "base_link", 0, {0, 0, 0.5}},
                                {"base_link", "lidar", 0, {1, 0, 1}}}));
  for (int i = 1; i < 4; ++i) {
    bag.add(tf, tf_message({{"odom", "base_footprint", i * kSecond_ns, {1.0 * i, 0, 0}, kQuarterTurn},
                            {"map", "odom", i * kSecond_ns + 7, {100, 0, 0}},
                            {"base_link", "wheel", i * kSecond_ns + 9, {0, 0.1 * i, 0}}}));
  }
  SECTION("to a frame behind a static link") {
    const auto poses = bag.poses("?tf=odom/base_link");
    REQUIRE(poses.size() == 3);
    CHECK(poses[1].stamp_ns == 2 * kSecond_ns);
    CHECK(poses[1].T_odom_base.translation_m.isApprox(Eigen::Vector3d(2, 0, 0.5), 1e-12));
  }
  SECTION("rotations are applied in order") {
    const auto poses = bag.poses("?tf=map/lidar");  // 1 m before base_link is 1 m to its left in odom
    REQUIRE(poses.size() == 3);
    CHECK(poses[1].T_odom_base.translation_m.isApprox(Eigen::Vector3d(102, 1, 1.5), 1e-12));
    CHECK(poses[1].T_odom_base.rotation.z() == Approx(std::sqrt(0.5)));
  }
  SECTION("what can't be had is refused with what there is") {
    CHECK_THAT(bag.read("?tf=odom/camera").error(),
               Contains("no way from odom to camera; its links: base_footprint/base_link, base_link/lidar, "
                        "base_link/wheel, map/odom, odom/base_footprint"));
    CHECK_THAT(bag.read("?tf=base_link/odom").error(), Contains("no way from base_link to odom"));
    CHECK_THAT(bag.read("?tf=odom/wheel").error(), Contains("of odom/wheel two links move"));
  }
}

TEST_CASE("a vehicle that stands all the time has odometry by tf all the same") {
  Bag bag;
  const auto tf = bag.topic("/robot/tf", kTfType);
  for (int i = 1; i < 4; ++i) bag.add(tf, tf_message({{"odom", "base_link", i * kSecond_ns, {1, 2, 3}}}));
  const auto poses = bag.poses("?tf=odom/base_link&topic=/robot/tf");
  REQUIRE(poses.size() == 3);
  CHECK(poses[0].T_odom_base.translation_m == Eigen::Vector3d(1, 2, 3));
}

TEST_CASE("sources that say nothing, or something else, are refused") {
  Bag bag;
  const auto topic = bag.topic("/odom", kOdometryType);
  bag.topic("/points", "sensor_msgs/msg/PointCloud2");
  CHECK_THAT(bag.read("?topic=/odom").error(), Contains("a.mcap /odom: no pose in it"));
  bag.add(topic, {0, 1});
  CHECK_THAT(bag.read("?topic=/odom").error(),
             Contains("no pose in it: message 1: byte 0: shorter than the head of a CDR message"));
  for (const char* options :
       {"", "?", "?topic=", "?tf=odom", "?tf=/base", "?tf=odom/", "?topic=/a&topic=/b", "?x=1"})
    CHECK_THAT(bag.read(options).error(),
               Contains("expected bag:PATH?topic=TOPIC or bag:PATH?tf=PARENT/CHILD"));
  CHECK_THAT(
      bag.read("?topic=/points").error(),
      Contains(
          "/points: is of type sensor_msgs/msg/PointCloud2 in cdr; nav_msgs/msg/Odometry in cdr is needed"));
  CHECK_THAT(bag.read("?topic=/none").error(),
             Contains("has no topic '/none'; it has: /odom (nav_msgs/msg/Odometry)"));
  std::vector<std::string> ignored;
  CHECK_THAT(services::read_odometry_source("bag:?topic=/odom", ignored).error(),
             Contains("(--bag PATH of gvom-map and gvom-run fills that in)"));
}
