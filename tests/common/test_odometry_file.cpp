// Recorded odometry, and what is wrong with a line in so many words.
#include <catch2/catch.hpp>

#include <cmath>

#include "services/common/odometry_file.hpp"
#include "tests/common/temporary_file.hpp"
#include "tests/support/recordings.hpp"

namespace {

using namespace gvom;
using Catch::Contains;

tl::expected<std::vector<StampedPose>, std::string> read(const std::string& source) {
  std::vector<std::string> ignored;
  return services::read_odometry_source(source, ignored);
}

std::string error_of(const std::string& text) {
  const test::TemporaryFile file(text);
  const auto poses = read("tum:" + file.path());
  return poses ? "no error" : poses.error().substr(file.path().size());
}

const std::string kFirst = "1.0 0 0 0 0 0 0 1\n";

}  // namespace

TEST_CASE("a recording with comments, blank lines and Windows line ends") {
  const test::TemporaryFile file(
      "# t x y z qx qy qz qw\r\n\r\n  1.5 1 2 3 0 0 0.6 0.8\r\n\t# more\n2.25 4 5 6 0 0 0 -1");
  const auto poses = read("tum:" + file.path());
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
  const auto poses = read("tum:" + file.path());
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

TEST_CASE("time that goes back is refused") {
  CHECK_THAT(error_of(kFirst + "0.9 0 0 0 0 0 0 1\n"),
             Contains(":2: expected time to go on from 1 s, found 0.9 s"));
}

TEST_CASE("of poses with the same stamp the first is taken, and it is told how many were left out") {
  const test::TemporaryFile file(kFirst + kFirst +
                                 "2.0 5 0 0 0 0 0 1\n2.0 6 0 0 0 0 0 1\n3.0 7 0 0 0 0 0 1\n");
  std::vector<std::string> warnings;
  const auto poses = services::read_odometry_source("tum:" + file.path(), warnings);
  REQUIRE(poses);
  REQUIRE(poses->size() == 3);
  CHECK((*poses)[1].T_odom_base.translation_m.x() == 5);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0] ==
        file.path() +
            ": left out 2 poses with the stamp of the pose before, 1 of them at another place; the "
            "first is in line 2");
}

TEST_CASE("times with too few digits for their poses are refused") {
  std::string text;
  for (int i = 0; i < 100; ++i) text += std::to_string(i / 10) + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
  CHECK(error_of(text) ==
        ": 90 poses have the stamp of another pose, the first in line 2: its times have too few digits");
}

const std::string kEurocHeader =
    "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n";

TEST_CASE("EuRoC: commas, nanoseconds, qw first") {
  const test::TemporaryFile file(kEurocHeader + "1403715524907143168, 1,2,3,0.8,0,0,0.6,9,9\r\n");
  for (const std::string scheme : {"euroc:", "tum:"}) {
    std::vector<std::string> warnings;
    const auto poses = services::read_odometry_source(scheme + file.path(), warnings);
    REQUIRE(poses);
    REQUIRE(poses->size() == 1);
    CHECK((*poses)[0].stamp_ns == 1403715524907143168);
    CHECK((*poses)[0].T_odom_base.translation_m == Eigen::Vector3d(1, 2, 3));
    CHECK((*poses)[0].T_odom_base.rotation.w() == Approx(0.8));
    CHECK((*poses)[0].T_odom_base.rotation.z() == Approx(0.6));
    CHECK(warnings.size() == (scheme == "tum:" ? 1 : 0));
  }
}

TEST_CASE("EuRoC's other files and other csv files are refused") {
  const auto euroc_error = [](const std::string& text) {
    const test::TemporaryFile file(text);
    const auto poses = read("euroc:" + file.path());
    return poses ? "no error" : poses.error().substr(file.path().size());
  };
  CHECK_THAT(euroc_error("1403715524907143168,1,2,3\n"), Contains(":1: expected at least 8 columns"));
  CHECK_THAT(euroc_error("1.5,1,2,3,1,0,0,0\n"),
             Contains("expected a time in whole nanoseconds, found '1.5'"));
  CHECK_THAT(euroc_error("#t,x,y,z,qx,qy,qz,qw\n1403715524907143168,1,2,3,0,0,0,1\n"),
             Contains("its column names are not EuRoC's"));
  CHECK_THAT(euroc_error(kFirst), Contains("this looks like TUM: use tum:FILE"));
}

TEST_CASE("KITTI: 3x4 matrices and a file of times") {
  const test::TemporaryFile poses_file("1 0 0 5 0 1 0 6 0 0 1 7\n0 -1 0 8 1 0 0 9 0 0 1 1e1\n");
  const test::TemporaryFile times_file("2011-09-26 13:02:25.5\n2011-09-26 13:02:25.6\n");
  const std::string source = "kitti:" + poses_file.path() + "?times=" + times_file.path();
  const auto poses = read(source);
  REQUIRE(poses);
  REQUIRE(poses->size() == 2);
  CHECK((*poses)[1].stamp_ns == 1317042145600000000);
  CHECK((*poses)[1].T_odom_base.translation_m == Eigen::Vector3d(8, 9, 10));
  CHECK((*poses)[1].T_odom_base.rotation.z() == Approx(std::sqrt(0.5)));

  const test::TemporaryFile one_time("1\n");
  CHECK(read("kitti:" + poses_file.path() + "?times=" + one_time.path()).error() ==
        poses_file.path() + ": 2 poses, but " + one_time.path() + " has 1 times");
  const test::TemporaryFile scaled("2 0 0 5 0 2 0 6 0 0 2 7\n");
  CHECK_THAT(read("kitti:" + scaled.path() + "?times=" + one_time.path()).error(),
             Contains(":1: expected a rotation"));
  const test::TemporaryFile mirrored("1 0 0 5 0 1 0 6 0 0 -1 7\n");
  CHECK_THAT(read("kitti:" + mirrored.path() + "?times=" + one_time.path()).error(),
             Contains(":1: expected a rotation"));
}

TEST_CASE("the refusal names the format that it recognised") {
  CHECK_THAT(
      error_of("1 0 0 5 0 1 0 6 0 0 1 7\n"),
      Contains(":1: expected 8 columns (t x y z qx qy qz qw), found 12; this looks like KITTI's 3x4 poses: "
               "use kitti:FILE?times=FILE"));
  CHECK_THAT(error_of("1403715524907143168,1,2,3,1,0,0,0\n"),
             Contains("this looks like EuRoC csv: use euroc:FILE"));
  CHECK_THAT(error_of("1403715524907143168 1 2 3 1 0 0 0\n"),
             Contains("this looks like TUM with nanoseconds"));
  CHECK_THAT(error_of("1.5,1,2,3,1,0,0,0\n"), Contains("this looks like a csv file"));
  CHECK_THAT(error_of("#ROSBAG V2.0\n\x01\n"), Contains("this is a ROS 1 bag"));
  CHECK_THAT(error_of(std::string("SQLite format 3\0\n", 17)), Contains("this is a ROS 2 bag"));
}

TEST_CASE("a byte-order mark of UTF-8 counts for nothing, UTF-16 is named") {
  CHECK(error_of("\xEF\xBB\xBF" + kFirst) == "no error");
  CHECK_THAT(error_of(std::string("\xFF\xFE#\0\n\0", 6)),
             Contains("is text in UTF-16 or UTF-32: save it as UTF-8"));
}

TEST_CASE("recordings that are not there or empty are refused") {
  CHECK(read("tum:/nonexistent.tum").error() == "/nonexistent.tum: No such file or directory");
  CHECK(read("tum:/tmp").error() == "/tmp: Is a directory");
  CHECK(error_of("# only words\n") == ": no pose in it");
  for (const char* source : {"", "tum", "tum:", "kitti:poses.txt", "x.tum"})
    CHECK_THAT(read(source).error(),
               Contains("expected tum:FILE, euroc:FILE, kitti:FILE?times=FILE, bag:PATH?topic=TOPIC or"));
}

TEST_CASE("the recordings' odometry is read whole") {
  const auto data = test::recordings();
  if (!data) return;
  const auto kitti = read("tum:" + *data + "/kitti_drive0005/odometry.tum");
  REQUIRE(kitti);
  CHECK(kitti->size() == 154);
  CHECK((*kitti)[1].stamp_ns == 100000000);
  const auto ouster = read("tum:" + *data + "/ouster_os1_128_moving/odometry.tum");
  REQUIRE(ouster);
  CHECK(ouster->size() == 4);
  CHECK(ouster->front().stamp_ns == 991587364520);
  const std::string drive = *data + "/kitti_drive0005/";
  const auto matrices = read("kitti:" + drive + "poses.txt?times=" + drive + "times.txt");
  REQUIRE(matrices);
  CHECK(matrices->size() == 10);
}

TEST_CASE("odometry files from the field are read") {
  const auto data = test::recordings();
  if (!data) return;
  const std::string field = *data + "/field/";
  std::vector<std::string> warnings;
  const auto repeated = services::read_odometry_source(
      "tum:" + field + "tum_duplicate_stamps/fr2_desk_groundtruth_cut.txt", warnings);
  REQUIRE(repeated);
  CHECK(warnings.size() == 1);
  const auto marked = read("tum:" + field + "odometry_formats/bom.tum");
  REQUIRE(marked);
  CHECK(marked->size() == 4);
  const auto euroc = read("euroc:" + field + "odometry_formats/V102_groundtruth_cut.csv");
  REQUIRE(euroc);
  CHECK((*euroc)[0].stamp_ns == 1403715524907143168);
  CHECK((*euroc)[0].T_odom_base.rotation.w() == Approx(0.161996).epsilon(1e-4));
}
