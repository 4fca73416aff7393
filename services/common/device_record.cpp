#include "services/common/device_record.hpp"

#include <time.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>
#include <string_view>

#include "services/common/own_file.hpp"

namespace gvom::services {

namespace {

using Failed = tl::unexpected<std::string>;

constexpr std::string_view kTitle = "gvom device failures, boot ";
constexpr std::size_t kLongestWords = 500;

std::optional<DeviceFailure> failure_in(const std::string& line) {
  DeviceFailure failure;
  const char* const end = line.data() + line.size();
  const auto [rest, error] = std::from_chars(line.data(), end, failure.since_boot_ns);
  if (error != std::errc() || rest == end || *rest != ' ' || failure.since_boot_ns < 0) return std::nullopt;
  failure.what.assign(rest + 1, end);
  return failure;
}

std::string one_line(std::string words) {
  words.resize(std::min(words.size(), kLongestWords));
  std::replace_if(
      words.begin(), words.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return words;
}

}  // namespace

BootMoment BootMoment::now() {
  BootMoment moment;
  moment.boot_id = gvom::services::boot_id();
  timespec time{};
  ::clock_gettime(CLOCK_BOOTTIME, &time);
  moment.since_boot_ns = std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
  return moment;
}

std::string device_record_of(const std::string& process) {
  return "/tmp/" + process + ".device-failures";
}

tl::expected<std::vector<DeviceFailure>, std::string> recent_failures(const std::string& path,
                                                                      const BootMoment& now) {
  const auto text = read_own(path);
  if (!text) return Failed(text.error());
  if (!*text) return {};
  const auto damaged = Failed(path + ": damaged");
  std::istringstream lines(**text);
  std::string line;
  if (!std::getline(lines, line) || line.rfind(kTitle, 0) != 0 || (*text)->back() != '\n') return damaged;
  if (line.substr(kTitle.size()) != now.boot_id) return {};
  std::vector<DeviceFailure> recent;
  while (std::getline(lines, line)) {
    auto failure = failure_in(line);
    if (!failure || failure->since_boot_ns > now.since_boot_ns) return damaged;
    if (now.since_boot_ns - failure->since_boot_ns < kFailuresWithin_ns)
      recent.push_back(std::move(*failure));
  }
  return recent;
}

tl::expected<void, std::string> add_failure(const std::string& path, const BootMoment& now,
                                            const std::string& what) {
  auto kept = recent_failures(path, now).value_or(std::vector<DeviceFailure>());
  kept.push_back({now.since_boot_ns, one_line(what)});
  const std::size_t first = kept.size() - std::min(kept.size(), kTooManyFailures);
  std::string text = std::string(kTitle) + now.boot_id + '\n';
  for (std::size_t i = first; i < kept.size(); ++i)
    text += std::to_string(kept[i].since_boot_ns) + ' ' + kept[i].what + '\n';
  return replace_own(path, text);
}

}  // namespace gvom::services
