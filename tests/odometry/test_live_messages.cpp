// Odometry out of messages of ROS 2.
#include <cmath>

#include <catch2/catch.hpp>

#include "services/odometry/live.hpp"
#include "tests/support/ros_messages.hpp"

using namespace gvom;
using namespace gvom::test;
using odometry::OdometryMessages;

namespace {

ros::Bytes bytes_of(const Octets& message) {
  return {message.data(), message.size()};
}

}  // namespace

TEST_CASE("a message's pose has its own stamp, and says of which frames it is") {
  OdometryMessages messages;
  CHECK(messages.frames().empty());
  const auto pose = messages.read(bytes_of(odometry_message(7'500'000'000, 3.25)));
  REQUIRE(pose);
  CHECK(pose->stamp_ns == 7'500'000'000);
  CHECK(pose->T_odom_base.translation_m.x() == 3.25);
  CHECK(messages.frames() == "base_link in odom");
}

TEST_CASE("another child frame than the first, what is no pose and what is cut are refused") {
  OdometryMessages messages;
  REQUIRE(messages.read(bytes_of(odometry_message(1, 0))));
  CHECK(messages.read(bytes_of(odometry_message(2, 0, "imu"))).error() ==
        "it is of imu in odom, not of base_link in odom");
  CHECK_FALSE(messages.read(bytes_of(odometry_message(2, std::nan("")))));
  Octets cut = odometry_message(2, 0);
  cut.resize(40);
  CHECK_FALSE(messages.read(bytes_of(cut)));
  CHECK(messages.read(bytes_of(odometry_message(1, 0))));  // in which order they come is for others to judge
}

TEST_CASE("only ros2: is live, and what is wrong with it is told before anything is opened") {
  CHECK(odometry::is_live("ros2:/odom"));
  CHECK_FALSE(odometry::is_live("tum:odometry.tum"));
#ifdef GVOM_HAS_DDS
  CHECK(odometry::fault_of("ros2:/odom?domain=5&interface=lo").empty());
  CHECK(odometry::fault_of("ros2:/tf?tf=odom/base_link&interface=lo").empty());
  CHECK(odometry::fault_of("ros2:odom") ==
        "odometry source 'ros2:odom': topic 'odom' does not begin with a slash");
  for (const char* source : {"ros2:/odom?domain", "ros2:/odom?domain=", "ros2:/odom?domain=1&domain=2",
                             "ros2:/tf?tf=odom", "ros2:/tf?tf=/base_link", "ros2:/odom?domain=-1"}) {
    INFO(source);
    CHECK_FALSE(odometry::fault_of(source).empty());
  }
#else
  CHECK_FALSE(odometry::fault_of("ros2:/odom").empty());
#endif
}
