#include "services/common/device_record.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

namespace gvom::services {

namespace {

using Failed = tl::unexpected<std::string>;

constexpr std::string_view kTitle = "gvom device failures, boot ";
constexpr std::size_t kLongestWords = 500;
constexpr std::size_t kLargestFile = 4096;  // bytes

Failed failed(const std::string& path, int error) {
  return Failed(path + ": " + std::strerror(error));
}

/// Nothing if there is no such file. /tmp is everybody's: it must be a plain file, and this user's.
tl::expected<std::optional<std::string>, std::string> read_own(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0 && errno == ENOENT) return std::nullopt;
  if (file < 0) return failed(path, errno);
  struct stat status {};
  const bool own = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == ::geteuid();
  std::string text(kLargestFile, '\0');
  const ssize_t got = own ? ::read(file, text.data(), text.size()) : 0;
  const int error = errno;
  ::close(file);
  if (!own) return Failed(path + ": not a file of this user");
  if (got < 0) return failed(path, error);
  text.resize(static_cast<std::size_t>(got));
  return text;
}

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

/// All of it or nothing, for a reader and when this process ends meanwhile.
tl::expected<void, std::string> replace(const std::string& path, const std::string& text) {
  std::string fresh = path + ".XXXXXX";
  const int file = ::mkstemp(fresh.data());
  if (file < 0) return failed(path, errno);
  errno = ENOSPC;  // a short write's reason
  const bool written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (written && ::close(file) == 0 && ::rename(fresh.c_str(), path.c_str()) == 0) return {};
  const int error = errno;
  if (!written) ::close(file);
  ::unlink(fresh.c_str());
  return failed(path, error);
}

}  // namespace

BootMoment BootMoment::now() {
  BootMoment moment;
  if (!(std::ifstream("/proc/sys/kernel/random/boot_id") >> moment.boot_id)) moment.boot_id = "unknown";
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
  return replace(path, text);
}

}  // namespace gvom::services
