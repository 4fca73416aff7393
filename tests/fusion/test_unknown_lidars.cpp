// Which lidars run beside a fusion that does not know them.
#include <catch2/catch.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include "services/fusion/unknown_lidars.hpp"

using namespace gvom;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

ipc::Progress progress_of(const std::string& reader) {
  ipc::Progress progress{};
  ipc::set_text(progress.reader, reader);
  return progress;
}

std::vector<std::string> names_at(const fusion::UnknownLidars& unknown, std::int64_t now_ns) {
  std::vector<std::string> names;
  unknown.for_each(now_ns, [&names](std::string_view name) { names.emplace_back(name); });
  return names;
}

}  // namespace

TEST_CASE("a lidar that is not in the configuration is unknown while it is heard") {
  std::vector<services::LidarConfig> known(1);
  known[0].name = "front";
  fusion::UnknownLidars unknown(known);
  for (const char* reader : {"front", "fusion", "", "Not a name", "left", "left"})
    unknown.take(progress_of(reader), 10 * kSecond_ns);
  CHECK(names_at(unknown, 11 * kSecond_ns) == std::vector<std::string>{"left"});
  CHECK(names_at(unknown, 13 * kSecond_ns).empty());
  unknown.take(progress_of("left"), 14 * kSecond_ns);
  CHECK(names_at(unknown, 14 * kSecond_ns).size() == 1);
}

TEST_CASE("of more than there is room for, the last heard are kept") {
  const std::vector<services::LidarConfig> known;
  fusion::UnknownLidars unknown(known);
  for (int i = 0; i < 40; ++i) unknown.take(progress_of("lidar" + std::to_string(i)), 10 * kSecond_ns + i);
  const auto names = names_at(unknown, 11 * kSecond_ns);
  CHECK(names.size() == kMaxLidars);
  CHECK(std::find(names.begin(), names.end(), "lidar39") != names.end());
}
