// Point clouds as drivers send them: where the fields lie, and what their times mean.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/ingest/bag_fixture.hpp"
#include "tests/ingest/frames_builder.hpp"

using namespace gvom;
using namespace gvom::test;

namespace {

constexpr std::int64_t kNoon_ns = 1'700'000'000'000'000'000;
const std::string kType = "sensor_msgs/msg/PointCloud2";

enum Datatype : std::uint8_t { kUint16 = 4, kUint32 = 6, kFloat32 = 7, kFloat64 = 8 };

template <typename T>
void put(Octets& point, std::size_t offset, T value, bool big_endian = false) {
  std::uint8_t bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof value);
  for (std::size_t i = 0; i < sizeof(T); ++i)
    point.at(offset + i) = bytes[big_endian ? sizeof(T) - 1 - i : i];
}

/// Points at (1 + i % 100, 0, 0) m, `bytes` each; `add_time` puts the time of point i.
template <typename AddTime>
Octets points(int count, std::size_t bytes, AddTime add_time) {
  Octets data;
  for (int i = 0; i < count; ++i) {
    Octets point(bytes, 0xEE);
    for (const std::size_t offset : {0, 4, 8})
      put(point, offset, offset == 0 ? 1.0f + static_cast<float>(i % 100) : 0.0f);
    add_time(point, i);
    append(data, point);
  }
  return data;
}

CloudLayout xyz_and(const CloudField& time, std::uint32_t point_step) {
  return {{{"x", 0, kFloat32}, {"y", 4, kFloat32}, {"z", 8, kFloat32}, {"ring", 12, kUint16}, time},
          point_step};
}

Sweep only_sweep(const std::string& uri) {
  auto sweeps = all_sweeps(*open(uri));
  REQUIRE(sweeps.size() == 1);
  return std::move(sweeps[0]);
}

/// Points 10 ms apart, the first at `first_ns`.
void check_times(const Sweep& sweep, std::int64_t first_ns, std::int64_t tolerance_ns = 0) {
  REQUIRE(sweep.returns.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(sweep.returns[i].x_m == 1.0 + static_cast<double>(i));
    const std::int64_t expected_ns = first_ns + static_cast<std::int64_t>(i) * 10'000'000;
    CHECK(std::abs(sweep.times_ns[sweep.returns[i].time_index] - expected_ns) <= tolerance_ns);
  }
  CHECK(sweep.stamp_ns == sweep.times_ns.back());
  CHECK(sweep.complete);
}

std::string refusal_of(const CloudLayout& layout, const Octets& data, const std::string& options = "") {
  TopicBag bag(kType);
  bag.add(1, cloud_message(kNoon_ns, layout, data));
  return open_error(bag.uri(options));
}

Octets ouster_points(int count = 4) {
  return points(count, 20,
                [](Octets& point, int i) { put(point, 14, static_cast<std::uint32_t>(i * 10'000'000)); });
}
const CloudLayout kOuster = xyz_and({"t", 14, kUint32}, 20);  // unaligned

}  // namespace

TEST_CASE("the times of four drivers' clouds") {
  TopicBag bag(kType);
  SECTION("Ouster: t, nanoseconds from the header's stamp") {
    bag.add(1, cloud_message(kNoon_ns, kOuster, ouster_points()));
    check_times(only_sweep(bag.uri()), kNoon_ns);
  }
  SECTION("Velodyne: time, seconds from the header's stamp, which is the last packet's") {
    const Octets data =
        points(4, 22, [](Octets& point, int i) { put(point, 18, -0.03f + 0.01f * static_cast<float>(i)); });
    bag.add(1, cloud_message(kNoon_ns, xyz_and({"time", 18, kFloat32}, 22), data));
    check_times(only_sweep(bag.uri()), kNoon_ns - 30'000'000, 10);
  }
  SECTION("Hesai and RoboSense: timestamp, absolute seconds") {
    const Octets data = points(4, 26, [](Octets& point, int i) { put(point, 18, 1.7e9 + 0.01 * i); });
    bag.add(1, cloud_message(5, xyz_and({"timestamp", 18, kFloat64}, 26), data));
    check_times(only_sweep(bag.uri()), kNoon_ns, 250);  // what a double holds of such a time
  }
  SECTION("Livox: timestamp, absolute nanoseconds") {
    const Octets data = points(4, 26, [](Octets& point, int i) { put(point, 18, 1.7e18 + 1e7 * i); });
    bag.add(1, cloud_message(5, xyz_and({"timestamp", 18, kFloat64}, 26), data));
    check_times(only_sweep(bag.uri()), kNoon_ns, 250);
  }
}

TEST_CASE("rows with gaps, and numbers of the other byte order") {
  TopicBag bag(kType);
  SECTION("rows") {
    const Octets plain = ouster_points();
    Octets data;
    for (int row = 0; row < 2; ++row) {
      data.insert(data.end(), plain.begin() + row * 40, plain.begin() + (row + 1) * 40);
      data.insert(data.end(), 7, 0xAA);
    }
    CloudLayout layout = kOuster;
    layout.height = 2;
    layout.row_padding = 7;
    bag.add(1, cloud_message(kNoon_ns, layout, data));
  }
  SECTION("big endian") {
    Octets data;
    for (int i = 0; i < 4; ++i) {
      Octets point(20, 0);
      put(point, 0, 1.0f + static_cast<float>(i), true);
      put(point, 14, static_cast<std::uint32_t>(i * 10'000'000), true);
      append(data, point);
    }
    CloudLayout layout = kOuster;
    layout.big_endian = true;
    bag.add(1, cloud_message(kNoon_ns, layout, data));
  }
  check_times(only_sweep(bag.uri()), kNoon_ns);
}

TEST_CASE("0, 0, 0 and NaN are no returns: their times count for nothing") {
  Octets data = ouster_points(6);
  for (const std::size_t offset : {0, 4, 8}) put(data, 4 * 20 + offset, 0.0f);
  put(data, 4 * 20 + 14, 0xFFFFFFFFu);
  put(data, 5 * 20, std::numeric_limits<float>::quiet_NaN());
  put(data, 5 * 20 + 14, 0xFFFFFFFFu);
  TopicBag bag(kType);
  bag.add(1, cloud_message(kNoon_ns, kOuster, data));
  const Sweep sweep = only_sweep(bag.uri());
  CHECK(sweep.stamp_ns == kNoon_ns + 30'000'000);
  CHECK(sweep.times_ns.size() == 4);
}

TEST_CASE("a cloud without times is refused, unless it is said that it is not to be deskewed") {
  const CloudLayout layout = xyz_and({"intensity", 14, kFloat32}, 20);
  const std::string refusal = refusal_of(layout, ouster_points());
  CHECK(refusal.find(
            "bag.mcap /lidar: message 1: its points have no times (t, time, timestamp or the like) among "
            "x, y, z, ring, intensity: such a cloud can't be deskewed; deskew=off maps it") !=
        std::string::npos);
  TopicBag bag(kType);
  bag.add(1, cloud_message(kNoon_ns, layout, ouster_points()));
  const Sweep sweep = only_sweep(bag.uri("&deskew=off"));
  CHECK(sweep.returns.size() == 4);
  CHECK(sweep.times_ns == std::vector<std::int64_t>{kNoon_ns});
}

TEST_CASE("deskew=off leaves times out that are there, and time= says their unit") {
  TopicBag bag(kType);
  bag.add(1, cloud_message(kNoon_ns, kOuster, ouster_points()));
  CHECK(only_sweep(bag.uri("&deskew=off")).times_ns == std::vector<std::int64_t>{kNoon_ns});
  check_times(only_sweep(bag.uri("&time=ns")), kNoon_ns);
  CHECK(open_error(bag.uri("&deskew=on")).find("deskew=on: expected off") != std::string::npos);
  CHECK(open_error(bag.uri("&time=h")).find("time=h: expected ns, us, ms, s or none") != std::string::npos);
  CHECK(open_error(bag.uri("&time=s&deskew=off")).find("exclude each other") != std::string::npos);
  CHECK(ingest::open_source(bag.uri(), {0.5, 1000, true}).error().what.find("clock: arrival needs packets") !=
        std::string::npos);
}

TEST_CASE("clouds whose parts don't fit together are refused with the reason") {
  const Octets data = ouster_points();
  CloudLayout layout = kOuster;
  layout.fields[4].datatype = 9;
  CHECK(refusal_of(layout, data).find("field 't' has the unknown datatype 9") != std::string::npos);
  layout = kOuster;
  layout.fields[4].offset = 17;
  CHECK(refusal_of(layout, data).find("field 't' does not lie within a point of 20 bytes") !=
        std::string::npos);
  layout.fields[4].offset = 0xFFFFFFFF;
  CHECK(refusal_of(layout, data).find("field 't' does not lie within") != std::string::npos);
  layout = kOuster;
  layout.fields[0].name = "X";
  CHECK(refusal_of(layout, data).find("no floating-point fields x, y, z") != std::string::npos);
  layout = kOuster;
  layout.row_padding = 0u - 20u;  // a row more than the data have
  CHECK(refusal_of(layout, data).find("its data have 80 bytes, too few for 1 rows of 5 points") !=
        std::string::npos);
  layout.height = 2;
  CHECK(refusal_of(layout, data).find("row_step is 40, a row has 60 bytes") != std::string::npos);
}

TEST_CASE("a cloud in the middle that can't be a sweep is passed over, counted and told") {
  TopicBag bag(kType);
  Octets cut = cloud_message(kNoon_ns, kOuster, ouster_points());
  cut.resize(cut.size() - 30);
  bag.add(1, cloud_message(kNoon_ns, kOuster, ouster_points()));
  bag.add(2, cut);
  bag.add(3, cloud_message(kNoon_ns + 100'000'000, kOuster, ouster_points()));
  const auto source = open(bag.uri());
  for (int round = 0; round < 2; ++round) {
    CHECK(all_sweeps(*source).size() == 2);
    REQUIRE(source->rewind().has_value());
  }
  CHECK(source->counters().foreign_packets == 2);
  CHECK(source->counters().sweeps == 4);
  REQUIRE(source->warnings().size() == 1);
  CHECK(source->warnings()[0].find("bag.mcap /lidar: message 2: byte ") != std::string::npos);
}

TEST_CASE("a first cloud that cannot be read is passed over like any other") {
  TopicBag bag(kType);
  Octets cut = cloud_message(kNoon_ns, kOuster, ouster_points());
  cut.resize(cut.size() - 30);
  bag.add(1, cut);
  CHECK(open_error(bag.uri()).find("bag.mcap /lidar: message 1: byte ") != std::string::npos);
  bag.add(2, cloud_message(kNoon_ns, kOuster, ouster_points()));
  const auto source = open(bag.uri());
  CHECK(all_sweeps(*source).size() == 1);
  CHECK(source->counters().foreign_packets == 1);
  REQUIRE(source->warnings().size() == 1);
  CHECK(source->warnings()[0].find("/lidar: message 1: byte ") != std::string::npos);
}

TEST_CASE("a cloud in millimetres is refused") {
  const auto millimetres = points(4, 20, [](Octets& point, int i) {
    put(point, 0, 1000.0f + static_cast<float>(i));
    put(point, 14, static_cast<std::uint32_t>(i * 10'000'000));
  });
  CHECK(refusal_of(kOuster, millimetres).find("4 of its 4 hits are beyond 500 m: not metres?") !=
        std::string::npos);
}

TEST_CASE("a driver that takes another field for the times, or another zero, is followed; with a word") {
  const auto stamp_ns = [](int cloud) { return kNoon_ns + cloud * 100'000'000LL; };
  const CloudLayout seconds = xyz_and({"t", 18, kFloat64}, 26);
  const auto since = [](double zero_s) {
    return points(4, 26, [=](Octets& point, int i) { put(point, 18, zero_s + 0.01 * i); });
  };
  TopicBag bag(kType);
  bag.add(1, cloud_message(stamp_ns(0), seconds, since(0)));
  SECTION("another field, at once") {
    bag.add(2, cloud_message(stamp_ns(1), kOuster, ouster_points()));
    const auto source = open(bag.uri());
    const auto sweeps = all_sweeps(*source);
    REQUIRE(sweeps.size() == 2);
    check_times(sweeps[1], stamp_ns(1));
    REQUIRE(source->warnings().size() == 1);
    CHECK(source->warnings()[0].find("the times are in the field 't U32', before in 't F64'") !=
          std::string::npos);
  }
  SECTION("another zero, after twenty clouds") {
    for (int i = 1; i <= 21; ++i) bag.add(1 + i, cloud_message(stamp_ns(i), seconds, since(1.7e9 + 0.1 * i)));
    const auto source = open(bag.uri());
    const auto sweeps = all_sweeps(*source);
    REQUIRE(sweeps.size() == 3);
    check_times(sweeps[1], stamp_ns(20), 250);
    CHECK(source->counters().foreign_packets == 19);
    const auto& told = source->warnings();
    CHECK(std::count_if(told.begin(), told.end(), [](const std::string& text) {
            return text.find("count from another zero than in the scans before: it is not used") !=
                   std::string::npos;
          }) == 2);  // the first and the tenth
    CHECK(told.back().find("for 20 scans: unit and origin are found out anew (s)") != std::string::npos);
  }
}

TEST_CASE("a driver that counts in microseconds from now on would not be deskewed: it is refused") {
  constexpr int kPoints = 2000;
  const auto step = [](int ticks) {
    return points(kPoints, 20,
                  [=](Octets& point, int i) { put(point, 14, static_cast<std::uint32_t>(i * ticks)); });
  };
  TopicBag bag(kType);
  bag.add(1, cloud_message(kNoon_ns, kOuster, step(50'000)));
  for (int i = 1; i <= 45; ++i)
    bag.add(1 + i, cloud_message(kNoon_ns + i * 100'000'000LL, kOuster, step(50)));
  const auto source = open(bag.uri());
  CHECK(all_sweeps(*source).size() == 1);
  CHECK(source->counters().foreign_packets == 45);
  REQUIRE(source->warnings().size() == 2);  // the first and the tenth
  CHECK(source->warnings()[0].find("'t' is not a time in ns as before: 2000 points") != std::string::npos);
  CHECK(std::string(source->counters().refusal.data()).find("'t' is not a time in ns as before") == 0);
}

TEST_CASE("points beyond max_returns are counted") {
  TopicBag bag(kType);
  bag.add(1, cloud_message(kNoon_ns, kOuster, ouster_points(10)));
  const auto source = open(bag.uri(), {0.5, 4});
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].returns.size() == 4);
  CHECK(source->counters().overflow_returns == 6);
}
