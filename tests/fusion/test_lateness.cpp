// How far behind the packets fusion says it is.
#include <catch2/catch.hpp>

#include <string>

#include "services/fusion/lateness.hpp"

using namespace gvom;

namespace {

constexpr std::int64_t kMs_ns = 1'000'000;

ipc::BrickMap map_published_at(std::int64_t mono_ns, std::uint32_t flags = 0) {
  ipc::BrickMap map{};
  map.mono_published_ns = mono_ns;
  map.flags = flags;
  return map;
}

std::string words_of(fusion::Lateness& lateness, std::int64_t now_ns) {
  services::Words words;
  lateness.describe({now_ns}, words);
  return std::string(words.text());
}

/// Layers of packets received `age_ns` before, each 100 ms for a second.
std::int64_t run_well(fusion::Lateness& lateness, std::int64_t now_ns, std::int64_t age_ns) {
  for (int i = 0; i < 10; ++i, now_ns += 100 * kMs_ns) {
    lateness.took(map_published_at(now_ns - kMs_ns), now_ns);
    lateness.published({now_ns - age_ns}, {now_ns});
  }
  return now_ns - 100 * kMs_ns;
}

}  // namespace

TEST_CASE("who keeps up is not behind, and nobody is before the first layers") {
  fusion::Lateness lateness;
  CHECK(lateness.age({5}) == ipc::kUnknownAge);
  const std::int64_t now_ns = run_well(lateness, 1000 * kMs_ns, 30 * kMs_ns);
  CHECK(lateness.age({now_ns}) == std::chrono::milliseconds(30));
  CHECK(words_of(lateness, now_ns).empty());
}

TEST_CASE("layers of old packets are behind by their age") {
  fusion::Lateness lateness;
  const std::int64_t now_ns = run_well(lateness, 10'000 * kMs_ns, 2059 * kMs_ns);
  CHECK(words_of(lateness, now_ns) == "the layers were 2.1 s behind the packets");
}

TEST_CASE("a pause is told by the age that the layers had reached, and for two seconds") {
  fusion::Lateness lateness;
  const std::int64_t paused_ns = run_well(lateness, 1000 * kMs_ns, 30 * kMs_ns);
  const std::int64_t again_ns = paused_ns + 3000 * kMs_ns;
  lateness.took(map_published_at(again_ns - 1600 * kMs_ns), again_ns);  // the oldest in the queue
  lateness.took(map_published_at(again_ns - 50 * kMs_ns), again_ns);
  lateness.published({again_ns - 80 * kMs_ns}, {again_ns});
  CHECK(words_of(lateness, again_ns) == "the layers were 3.0 s behind the packets");
  const std::int64_t later_ns = run_well(lateness, again_ns + 2000 * kMs_ns, 30 * kMs_ns);
  CHECK(words_of(lateness, later_ns).empty());
}

TEST_CASE("a lidar that was silent for a while does not put fusion behind") {
  fusion::Lateness lateness;
  const std::int64_t silent_ns = run_well(lateness, 1000 * kMs_ns, 30 * kMs_ns);
  const std::int64_t again_ns = run_well(lateness, silent_ns + 3000 * kMs_ns, 30 * kMs_ns);
  CHECK(words_of(lateness, again_ns).empty());
}

TEST_CASE("a replay that waits for its readers is never late") {
  fusion::Lateness lateness;
  lateness.took(map_published_at(1, ipc::BrickMap::kLossless), 9000 * kMs_ns);
  lateness.published({kMs_ns}, {9000 * kMs_ns});
  CHECK(words_of(lateness, 9000 * kMs_ns).empty());
}
