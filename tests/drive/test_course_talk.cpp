// A vehicle that joins a planner which runs already: what it said before is none of this drive.
#include <catch2/catch.hpp>

#include <cmath>

#include "tools/drive/live/course_talk.hpp"

using gvom::driving::CourseTalk;

namespace {

constexpr std::uint64_t kEpoch = 7;
constexpr std::int64_t kSent_ns = 1'000;
const std::vector<Eigen::Vector2d> kCourse = {{30, 2}, {60.25, -1.5}};

/// Made a moment after the course was sent, of its second place.
gvom::ipc::Plan plan() {
  gvom::ipc::Plan plan{};
  plan.header.epoch = kEpoch;
  plan.mono_begun_ns = kSent_ns + 1;
  plan.layers_age_s = 0.1;
  plan.waypoints = 2;
  plan.waypoint = 1;
  plan.goal_x_m = 60.25;
  plan.goal_y_m = -1.5;
  return plan;
}

CourseTalk talk() {
  return {kCourse, kEpoch, 0.5};
}

}  // namespace

TEST_CASE("the course is sent to a planner that has this vehicle's odometry and a map that is not old") {
  CHECK(talk().is_ready(plan()));
  auto other = plan();
  other.header.epoch = kEpoch - 1;  // the drive before
  CHECK_FALSE(talk().is_ready(other));
  for (const double age_s : {0.51, 25.0, HUGE_VAL, std::nan("")}) {
    auto old = plan();
    old.layers_age_s = age_s;
    CHECK_FALSE(talk().is_ready(old));
  }
}

TEST_CASE("a plan counts if it was made after the course was sent, by it, of this vehicle") {
  CourseTalk sent = talk();
  CHECK_FALSE(sent.is_of_course(plan()));
  sent.sent(kSent_ns);
  CHECK(sent.is_of_course(plan()));
  const auto counts_with = [&](void (*change)(gvom::ipc::Plan&)) {
    auto changed = plan();
    change(changed);
    return sent.is_of_course(changed);
  };
  CHECK_FALSE(counts_with([](auto& p) { p.mono_begun_ns = kSent_ns; }));
  CHECK_FALSE(counts_with([](auto& p) { p.header.epoch = kEpoch - 1; }));
  CHECK_FALSE(counts_with([](auto& p) { p.waypoints = 0; }));
  CHECK_FALSE(counts_with([](auto& p) { p.waypoints = 3; }));
  CHECK_FALSE(counts_with([](auto& p) { p.waypoint = 2; }));
  CHECK_FALSE(counts_with([](auto& p) { p.waypoint = 0; }));
  CHECK_FALSE(counts_with([](auto& p) { p.goal_y_m = 0; }));
}
