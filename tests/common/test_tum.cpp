// TUM files: stamps to the nanosecond, and what is wrong with a line in so many words.
#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>

#include "services/common/tum.hpp"
#include "tests/common/temporary_file.hpp"
#include "tests/support/recordings.hpp"

namespace {

using namespace gvom;
using Catch::Contains;
using services::parse_stamp_ns;

std::string error_of(const std::string& text) {
  const test::TemporaryFile file(text);
  const auto poses = services::read_tum(file.path());
  return poses ? "no error" : poses.error().substr(file.path().size());
}

const std::string kFirst = "1.0 0 0 0 0 0 0 1\n";

}  // namespace

TEST_CASE("stamps are exact to the nanosecond, where a double is not") {
  CHECK(parse_stamp_ns("1311868163.869999886") == 1311868163869999886);
  CHECK(parse_stamp_ns("1.311868163869999886e+09") == 1311868163869999886);
  CHECK(parse_stamp_ns("991.58736452") == 991587364520);
  CHECK(parse_stamp_ns("0") == 0);
  CHECK(parse_stamp_ns("0.0000000005") == 1);  // half away from zero
  CHECK(parse_stamp_ns("0.00000000049") == 0);
  CHECK(parse_stamp_ns("1e-9") == 1);
  CHECK(parse_stamp_ns("1e-10") == 0);
  CHECK(parse_stamp_ns("1e-30") == 0);
  CHECK(parse_stamp_ns("-1.5") == -1500000000);
  CHECK(parse_stamp_ns("+7.") == 7000000000);
  CHECK(parse_stamp_ns(".5") == 500000000);
  CHECK(parse_stamp_ns("9223372036.854775807") == INT64_MAX);
}

TEST_CASE("what is no stamp is none") {
  for (const char* text : {"", "-", ".", "e5", "1e", "nan", "inf", "1.2.3", "0x10", "1,5", "1e99999", "1e5x",
                           "1e5000", "9223372036.854775808", "99999999999", "1.5e-2147483648"}) {
    INFO(text);
    CHECK_FALSE(parse_stamp_ns(text));
  }
}

TEST_CASE("a recording with comments, blank lines and Windows line ends") {
  const test::TemporaryFile file(
      "# t x y z qx qy qz qw\r\n\r\n  1.5 1 2 3 0 0 0.6 0.8\r\n\t# more\n2.25 4 5 6 0 0 0 -1");
  const auto poses = services::read_odometry_source("tum:" + file.path());
  REQUIRE(poses);
  REQUIRE(poses->size() == 2);
  CHECK((*poses)[0].stamp_ns == 1500000000);
  CHECK((*poses)[0].T_odom_base.translation_m == Eigen::Vector3d(1, 2, 3));
  CHECK((*poses)[0].T_odom_base.rotation.z() == Approx(0.6));
  CHECK((*poses)[0].T_odom_base.rotation.w() == Approx(0.8));
  CHECK((*poses)[1].stamp_ns == 2250000000);
}

TEST_CASE("quaternions that are nearly of unit length are made so") {
  const test::TemporaryFile file("1 0 0 0 0 0 0 1.0009\n");
  const auto poses = services::read_tum(file.path());
  REQUIRE(poses);
  CHECK((*poses)[0].T_odom_base.rotation.w() == 1.0);
}

TEST_CASE("bad lines are refused with their number and the reason") {
  CHECK(error_of(kFirst + "2.0 nan 0 0 0 0 0 1\n") == ":2: expected a finite number, found 'nan'");
  CHECK(error_of(kFirst + "2.0 0 inf 0 0 0 0 1\n") == ":2: expected a finite number, found 'inf'");
  CHECK(error_of(kFirst + "2.0 0 0 0 0 0 0 -nan\n") == ":2: expected a finite number, found '-nan'");
  CHECK(error_of(kFirst + "nan 0 0 0 0 0 0 1\n") == ":2: expected a time in seconds, found 'nan'");
  CHECK(error_of(kFirst + "2.0 0 0 1m 0 0 0 1\n") == ":2: expected a finite number, found '1m'");
  CHECK(error_of("# c\n\n2.0 0 0 0 0 0 1\n") == ":3: expected 8 columns (t x y z qx qy qz qw), found 7");
  CHECK(error_of("2.0 0 0 0 0 0 0 1 9\n") == ":1: expected 8 columns (t x y z qx qy qz qw), found 9");
  CHECK_THAT(error_of("2.0 0 0 0 0 0 0 0\n"),
             Contains(":1: expected a unit quaternion, found one of norm 0"));
  CHECK_THAT(error_of("2.0 0 0 0 0 0 0 1.0011\n"), Contains("expected a unit quaternion"));
}

TEST_CASE("time that stands still or goes back is refused") {
  CHECK_THAT(error_of(kFirst + "0.9 0 0 0 0 0 0 1\n"), Contains(":2: expected time to go on, found 0.9"));
  CHECK_THAT(error_of(kFirst + kFirst), Contains(":2: expected time to go on"));
}

TEST_CASE("recordings that are not there or empty are refused") {
  CHECK(services::read_tum("/nonexistent.tum").error() == "/nonexistent.tum: No such file or directory");
  CHECK(services::read_tum("/tmp").error() == "/tmp: Is a directory");
  CHECK(error_of("# only words\n") == ": no pose in it");
  CHECK_THAT(services::read_odometry_source("bag:x").error(), Contains("expected tum:FILE"));
}

TEST_CASE("the recordings' odometry is read whole") {
  const auto data = test::recordings();
  if (!data) return;
  const auto kitti = services::read_tum(*data + "/kitti_drive0005/odometry.tum");
  REQUIRE(kitti);
  CHECK(kitti->size() == 154);
  CHECK((*kitti)[1].stamp_ns == 100000000);
  const auto ouster = services::read_tum(*data + "/ouster_os1_128_moving/odometry.tum");
  REQUIRE(ouster);
  CHECK(ouster->size() == 4);
  CHECK(ouster->front().stamp_ns == 991587364520);
}
