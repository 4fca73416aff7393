// The one answer to how old layers are.
#include <catch2/catch.hpp>

#include "ipc/freshness.hpp"

using namespace gvom::ipc;
using namespace std::chrono_literals;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::chrono::nanoseconds age_at(const Moment& now, std::int64_t received_ns, std::int64_t suspended_ns = 0) {
  Layers layers{};
  layers.mono_received_ns = received_ns;
  layers.suspended_ns = suspended_ns;
  layers.mono_published_ns = now.mono_ns;  // just now, and of no weight
  return elapsed(received_at(layers), now);
}

}  // namespace

TEST_CASE("the age of layers is that of their newest packet") {
  CHECK(age_at({10 * kSecond_ns}, 10 * kSecond_ns) == 0s);
  CHECK(age_at({10 * kSecond_ns}, 10 * kSecond_ns - 2'059'000'000) == 2059ms);
}

TEST_CASE("the time that the machine slept counts, though its clock stood still") {
  constexpr std::int64_t kNight_ns = 8 * 3600 * kSecond_ns;
  CHECK(age_at({10 * kSecond_ns, kNight_ns}, 9 * kSecond_ns) == 8h + 1s);
  CHECK(age_at({10 * kSecond_ns, kNight_ns}, 9 * kSecond_ns, kNight_ns) == 1s);
  CHECK(age_at({10 * kSecond_ns, 0}, 9 * kSecond_ns, 1'000'000) == 1s);  // two looks differ by a rounding
}

TEST_CASE("packets that never came, or are to come, are older than any limit") {
  CHECK(age_at({10 * kSecond_ns}, 0) == kUnknownAge);
  CHECK(age_at({10 * kSecond_ns}, -5) == kUnknownAge);
  CHECK(age_at({10 * kSecond_ns}, 10 * kSecond_ns + 1) == kUnknownAge);
  CHECK(kUnknownAge > 1000h);
  CHECK(age_words(2059ms) == "2.1 s old");
  CHECK(age_words(kUnknownAge).find("of unknown age") == 0);
}

TEST_CASE("this machine's moments go on") {
  const Moment before = Moment::now();
  CHECK(before.mono_ns > 0);
  CHECK(before.suspended_ns >= 0);
  const auto since = elapsed(before, Moment::now());
  CHECK(since >= 0s);
  CHECK(since < 1h);
}
