#include <catch2/catch.hpp>
#include <map>

#include "services/planner/bucket_queue.hpp"
#include "tests/core/random.hpp"

namespace gvom::test {
namespace {

using planner::BucketQueue;

TEST_CASE("Items come in the order of their buckets, moved ones where they were put last") {
  constexpr int kItems = 50;
  constexpr double kSpan = 30, kWidth = 0.5;
  BucketQueue queue(kItems);
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    std::map<int, double> keys;
    double lowest = 100;
    queue.clear(100, kSpan, kWidth);
    for (int step = 0; step < 2000; ++step) {
      if (random.chance(0.6)) {
        const int item = random.integer(0, kItems - 1);
        keys[item] = lowest + random.uniform(0, kSpan - kWidth);
        queue.put(item, static_cast<float>(keys[item]));
        continue;
      }
      const int item = queue.take();
      INFO("seed " << seed << ", step " << step);
      REQUIRE((item == BucketQueue::kNone) == keys.empty());
      if (keys.empty()) continue;
      REQUIRE(keys.count(item) == 1);
      for (const auto& [other, key] : keys) REQUIRE(keys[item] <= key + kWidth + 1e-4);
      lowest = std::max(lowest, keys[item]);
      keys.erase(item);
    }
  }
}

TEST_CASE("A span that needs wider buckets gets them") {
  BucketQueue queue(3);
  queue.clear(0, 1e6F, 0.4F);
  queue.put(0, 1e6F);
  queue.put(1, 5e5F);
  queue.put(2, 0);
  CHECK(queue.take() == 2);
  CHECK(queue.take() == 1);
  CHECK(queue.take() == 0);
  CHECK(queue.take() == BucketQueue::kNone);
}

}  // namespace
}  // namespace gvom::test
