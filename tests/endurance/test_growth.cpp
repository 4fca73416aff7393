// What grows, told from samples.
#include <catch2/catch.hpp>

#include "tools/endurance/growth.hpp"

using namespace gvom::endurance;

namespace {

Series line(int count, double begin, double per_s) {
  Series series;
  for (int i = 0; i < count; ++i) series.add(i, begin + per_s * i);
  return series;
}

}  // namespace

TEST_CASE("what stays the same does not grow, whatever single samples say") {
  Series series = line(100, 5000, 0);
  series.add(100, 9000);
  const auto growth = growth_of(series, 0);
  REQUIRE(growth);
  CHECK(growth->change() == 0);
  CHECK(growth->most == 9000);
}

TEST_CASE("growth is told for an hour") {
  const auto growth = growth_of(line(400, 0, 2), 0);
  REQUIRE(growth);
  CHECK(growth->change() == Approx(600));  // three quarters of the time lie between the two
  CHECK(growth->per_hour() == Approx(7200).epsilon(0.01));
}

TEST_CASE("what was before the warm-up's end counts for nothing") {
  Series series = line(50, 0, 1000);
  for (int i = 50; i < 200; ++i) series.add(i, 70000);
  CHECK(growth_of(series, 50)->change() == 0);
  CHECK(growth_of(series, 0)->change() > 0);
}

TEST_CASE("what comes and goes with the load is measured when it is least") {
  Series busy;
  for (int i = 0; i < 200; ++i) busy.add(i, i % 10 == 0 ? 12 : (i < 100 ? 30 : 80));
  CHECK(growth_of(busy, 0)->change() == 50);
  CHECK(growth_of(busy, 0, Measure::least)->change() == 0);
}

TEST_CASE("a few samples tell nothing") {
  CHECK_FALSE(growth_of(line(static_cast<int>(kLeastSamples) - 1, 0, 1), 0));
  CHECK(growth_of(line(static_cast<int>(kLeastSamples), 0, 1), 0));
  CHECK_FALSE(growth_of(Series{}, 0));
}

TEST_CASE("days of samples fit in bounded memory and tell the same") {
  const Series series = line(300'000, 10, 0.5);
  CHECK(series.points().size() <= 1024);
  CHECK(growth_of(series, 0)->per_hour() == Approx(1800).epsilon(0.01));
}

TEST_CASE("the median") {
  CHECK(median({}) == 0);
  CHECK(median({3}) == 3);
  CHECK(median({9, 1, 5}) == 5);
}
