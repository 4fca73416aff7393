// Odometry out of /tf and /tf_static, as they come.
#include <cmath>

#include <catch2/catch.hpp>

#include "services/odometry/tf_messages.hpp"
#include "tests/support/ros_messages.hpp"

using namespace gvom;
using namespace gvom::test;
using Catch::Matchers::Contains;
using odometry::TfMessages;

namespace {

const double kHalf = std::sqrt(0.5);

ros::Bytes bytes_of(const Octets& message) {
  return {message.data(), message.size()};
}

/// base_link is 0.5 m above base_footprint, and looks to its left.
Link mount(double up_m = 0.5) {
  return {"base_footprint", "base_link", 0, {0, 0, up_m}, {0, 0, kHalf, kHalf}};
}

Link moved(std::int64_t stamp_ns, double x_m) {
  return {"odom", "base_footprint", stamp_ns, {x_m, 0, 0}};
}

std::vector<StampedPose> read(TfMessages& messages, const std::vector<Link>& links) {
  const Octets message = tf_message(links);
  const auto poses = messages.read(bytes_of(message));
  REQUIRE(poses);
  return *poses;
}

void stand(TfMessages& messages, const std::vector<Link>& links) {
  const Octets message = tf_message(links);
  REQUIRE(messages.stand(bytes_of(message)));
}

}  // namespace

TEST_CASE("a pose is the link that moves and those that stand, at the stamp of the first") {
  TfMessages messages({"odom", "base_link"});
  stand(messages, {mount(), {"base_link", "lidar", 0, {1, 0, 1}}});
  const auto poses = read(messages, {{"base_link", "wheel", 5}, moved(7, 3), moved(8, 4)});
  REQUIRE(poses.size() == 2);
  CHECK(poses[0].stamp_ns == 7);
  CHECK(poses[1].stamp_ns == 8);
  CHECK((poses[1].T_odom_base.translation_m - Eigen::Vector3d(4, 0, 0.5)).norm() < 1e-12);
  const Eigen::Vector3d ahead = poses[1].T_odom_base.rotation * Eigen::Vector3d::UnitX();
  CHECK((ahead - Eigen::Vector3d::UnitY()).norm() < 1e-12);
  CHECK(messages.frames() == "base_link in odom, by odom/base_footprint");
  CHECK(messages.missing().empty());
}

TEST_CASE("without a way there is no pose, and which links there are is told; with the late one there is") {
  TfMessages messages({"odom", "base_link"});
  CHECK_FALSE(messages.missing().empty());
  CHECK(read(messages, {moved(1, 0)}).empty());
  CHECK(messages.missing() == "no way from odom to base_link; its links: odom/base_footprint");
  stand(messages, {mount()});
  CHECK(read(messages, {moved(2, 0)}).size() == 1);
}

TEST_CASE("what stands may be set anew, and is then as it is said to be") {
  TfMessages messages({"odom", "base_link"});
  stand(messages, {mount(0.5)});
  CHECK(read(messages, {moved(1, 0)})[0].T_odom_base.translation_m.z() == 0.5);
  stand(messages, {mount(0.75)});
  CHECK(read(messages, {moved(2, 0)})[0].T_odom_base.translation_m.z() == 0.75);
}

TEST_CASE("two links that move, and none, are no odometry") {
  TfMessages two({"odom", "base_link"});
  CHECK(read(two, {moved(1, 0), mount()}).empty());
  CHECK_THAT(two.missing(), Contains("two links move, odom/base_footprint and base_footprint/base_link"));
  stand(two, {mount()});  // both on /tf_static and on /tf: it moves
  CHECK(read(two, {moved(2, 0)}).empty());
  TfMessages none({"odom", "base_link"});
  stand(none, {moved(0, 0), mount()});
  CHECK(none.missing() == "nothing between odom and base_link moves");
}

TEST_CASE("a link that begins to move while others are read is noticed at once") {
  TfMessages messages({"odom", "base_link"});
  stand(messages, {mount()});
  CHECK(read(messages, {moved(1, 0)}).size() == 1);
  CHECK(read(messages, {mount()}).empty());
  CHECK(read(messages, {moved(2, 0)}).empty());
}

TEST_CASE("damaged messages and transforms that are none are refused, and the next is read") {
  TfMessages messages({"odom", "base_link"});
  stand(messages, {mount()});
  Octets cut = tf_message({moved(1, 0)});
  cut.resize(cut.size() - 9);
  CHECK_FALSE(messages.read(bytes_of(cut)));
  CHECK_FALSE(messages.stand(bytes_of(cut)));
  const Octets bad = tf_message({moved(2, std::nan(""))});
  CHECK_THAT(messages.read(bytes_of(bad)).error(), Contains("odom/base_footprint: "));
  CHECK(read(messages, {moved(3, 1)}).size() == 1);
}

TEST_CASE("links that go round in a ring end nothing") {
  TfMessages messages({"odom", "base_link"});
  stand(messages, {{"a", "b"}, {"b", "a"}, {"b", "base_link"}});
  CHECK(read(messages, {moved(1, 0)}).empty());
  CHECK_THAT(messages.missing(), Contains("no way from odom to base_link"));
}
