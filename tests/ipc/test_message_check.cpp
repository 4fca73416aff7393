// What is let through can be read, whoever sent it: fields that no map or layers can have are refused.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "ipc/layout.hpp"
#include "ipc/topic.hpp"
#include "tests/ipc/two_bricks.hpp"

using namespace gvom;
using namespace gvom::ipc;
using gvom::ipc::test::TwoBricks;

namespace {

constexpr int kSize = 8;
constexpr char kNoPose[] = "it has a pose that is not finite, or over 10,000 km away";
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Why it is refused; empty if it is not.
std::string refusal_of(TwoBricks& map) {
  const auto refusal = check_message(*buffer_map_topic("top"), map.data(), map.bytes());
  return refusal ? refusal->why : "";
}

/// The refusal of a map with one thing wrong.
template <typename Spoil>
std::string refusal_of(const Spoil& spoil) {
  TwoBricks map;
  spoil(map.header());
  return refusal_of(map);
}

/// Of a message of fixed size that is right but for what is done to it.
template <class M>
std::string refusal_of_fixed(const std::function<void(M&)>& spoil) {
  auto message = std::make_unique<M>();
  message->header = {kMagic, static_cast<std::uint16_t>(M::kType), M::kVersion, sizeof(M), 1, 0, 0};
  spoil(*message);
  const auto refusal = check_message(topic_of<M>(), reinterpret_cast<std::byte*>(message.get()), sizeof(M));
  return refusal ? refusal->why : "";
}

}  // namespace

TEST_CASE("a message of another version is refused, and the release that it is of is named") {
  const auto refusal_of_version = [](const Topic& topic, int version) {
    MessageHeader header{};
    header.magic = kMagic;
    header.type = static_cast<std::uint16_t>(topic.type);
    header.version = static_cast<std::uint16_t>(version);
    header.size = sizeof header;
    const auto refusal = check_message(topic, reinterpret_cast<std::byte*>(&header), sizeof header);
    REQUIRE(refusal);
    CHECK(refusal->reason == Refusal::Reason::version);
    return refusal->why;
  };
  const std::string ours = std::string(") refused, this is ") + release() + " (version ";
  CHECK(std::string(release()) == "0.3.0");
  CHECK(refusal_of_version(layers_topic(), 1) == "message of gvom 0.2 (version 1" + ours + "2)");
  CHECK(refusal_of_version(layers_topic(), 3) == "message of a newer gvom (version 3" + ours + "2)");
  CHECK(refusal_of_version(*buffer_map_topic("top"), 2) == "message of gvom 0.2 (version 2" + ours + "4)");
  CHECK(refusal_of_version(voxel_map_topic(), 1) == "message of gvom 0.1 (version 1" + ours + "4)");
  CHECK(refusal_of_version(topic_of<Health>(), 2) == "message of gvom 0.2 (version 2" + ours + "3)");
  for (const Topic& topic :
       {layers_topic(), *buffer_map_topic("top"), voxel_map_topic(), topic_of<Health>(), topic_of<Odometry>(),
        topic_of<Progress>(), topic_of<Course>(), topic_of<Plan>(), topic_of<Command>()})
    for (int version = 0; version < topic.version + 3; ++version)
      if (version != topic.version) CHECK_FALSE(refusal_of_version(topic, version).empty());
}

TEST_CASE("a vehicle is not moved by numbers that are none") {
  CHECK(refusal_of_fixed<Command>([](Command&) {}).empty());
  for (const double number : {kNan, HUGE_VAL, -HUGE_VAL}) {
    CHECK(refusal_of_fixed<Command>([&](Command& command) { command.speed_mps = number; }) ==
          "it has a speed or a curvature that is not finite");
    CHECK_FALSE(
        refusal_of_fixed<Command>([&](Command& command) { command.curvature_per_m = number; }).empty());
    CHECK_FALSE(refusal_of_fixed<Course>([&](Course& course) {
                  course.count = 2;
                  course.places[1].y_m = number;
                }).empty());
  }
  CHECK(refusal_of_fixed<Course>([](Course& course) {
          course.places[0].x_m = kNan;
        }).empty());  // not one of it
}

TEST_CASE("more places and points than a message has room for are refused") {
  CHECK(refusal_of_fixed<Course>([](Course& course) { course.count = Course::kMaxPlaces; }).empty());
  CHECK(refusal_of_fixed<Course>([](Course& course) { course.count = Course::kMaxPlaces + 1; }) ==
        "it claims 257 places, at most 256 can be");
  CHECK(refusal_of_fixed<Plan>([](Plan& plan) { plan.path_count = Plan::kMaxPoints; }).empty());
  CHECK_FALSE(refusal_of_fixed<Plan>([](Plan& plan) { plan.path_count = Plan::kMaxPoints + 1; }).empty());
  CHECK_FALSE(
      refusal_of_fixed<Plan>([](Plan& plan) { plan.trajectory_count = Plan::kMaxPoints + 1; }).empty());
}

TEST_CASE("fractions of a sweep's columns that cannot be are refused") {
  for (const float fraction : {0.0F, 0.5F, 1.0F})
    CHECK(refusal_of([&](BrickMap& map) { map.columns_seen_fraction = fraction; }).empty());
  for (const float fraction : {-0.1F, 1.01F, static_cast<float>(kNan)})
    CHECK_FALSE(refusal_of([&](BrickMap& map) { map.columns_seen_fraction = fraction; }).empty());
}

TEST_CASE("a map is let through, whatever its arrays hold") {
  TwoBricks map;
  CHECK(refusal_of(map).empty());
  map.directory()[0] = 1000;
  CHECK(refusal_of(map).empty());
}

TEST_CASE("stamps whose differences would not fit are refused") {
  constexpr std::int64_t kMost_ns = 4'000'000'000'000'000'000;
  for (const std::int64_t stamp_ns : {kMost_ns, -kMost_ns})
    CHECK(refusal_of([&](BrickMap& map) { map.header.stamp_ns = stamp_ns; }).empty());
  for (const std::int64_t stamp_ns : {kMost_ns + 1, std::numeric_limits<std::int64_t>::min()})
    CHECK(refusal_of([&](BrickMap& map) { map.header.stamp_ns = stamp_ns; }) ==
          "its stamp is " + std::to_string(stamp_ns) + " ns");
}

TEST_CASE("so are times of this machine's clock, of a map and of layers") {
  constexpr std::int64_t kLeast_ns = std::numeric_limits<std::int64_t>::min();
  const std::string why = "it has a time of " + std::to_string(kLeast_ns) + " ns";
  CHECK(refusal_of([](BrickMap& map) { map.mono_received_ns = kLeast_ns; }) == why);
  CHECK(refusal_of([](BrickMap& map) { map.odometry_jump_ns = kLeast_ns; }) == why);

  std::vector<std::byte> memory(layers_bytes(kSize));
  auto& layers = *new (memory.data()) Layers{};
  layers.header = {kMagic, static_cast<std::uint16_t>(Layers::kType), Layers::kVersion, memory.size(), 1, 0,
                   0};
  for (auto& size : layers.grid.size) size = kSize;
  CHECK_FALSE(check_message(layers_topic(), memory.data(), memory.size()));
  layers.mono_published_ns = kLeast_ns;
  CHECK(check_message(layers_topic(), memory.data(), memory.size())->why == why);
}

TEST_CASE("a grid that begins where none can is refused") {
  CHECK(refusal_of([](BrickMap& map) {
          map.grid.origin[0] = -(1 << 30);
          map.grid.resolution_m[0] = 0.005;
          map.T_odom_base.position_m[0] = 0.005 * -(1 << 30);
        }).empty());
  CHECK(refusal_of([](BrickMap& map) { map.grid.origin[1] = 4; }) == "it claims to begin at voxel (0, 4, 0)");
  CHECK(refusal_of([](BrickMap& map) { map.grid.origin[2] = 2147483640; }) ==
        "it claims to begin at voxel (0, 0, 2147483640)");
}

TEST_CASE("a map is laid around its vehicle, to a brick, or refused") {
  const std::string why = "it has its vehicle outside of its grid";
  const auto with_vehicle_at = [](std::size_t axis, double position_m) {
    return refusal_of([&](BrickMap& map) { map.T_odom_base.position_m[axis] = position_m; });
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double edge_m = (axis < 2 ? 16 : 8) * 0.4;
    CHECK(with_vehicle_at(axis, edge_m + 3.1).empty());
    CHECK(with_vehicle_at(axis, edge_m + 3.3) == why);
    CHECK(with_vehicle_at(axis, -0.1) == why);
  }
  CHECK(refusal_of([](BrickMap& map) { map.grid.resolution_m[1] = 0; }) == why);
  CHECK(refusal_of([](BrickMap& map) { map.grid.resolution_m[1] = kNan; }) == why);
}

TEST_CASE("a pose that is not finite, or not on Earth, is refused") {
  CHECK(refusal_of([](BrickMap& map) { map.T_odom_base.position_m[1] = kNan; }) == kNoPose);
  CHECK(refusal_of([](BrickMap& map) { map.T_odom_base.orientation_xyzw[0] = INFINITY; }) == kNoPose);
  CHECK(refusal_of([](BrickMap& map) { map.T_odom_base.position_m[2] = 1e300; }) == kNoPose);
}
