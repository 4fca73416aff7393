#include "tools/common/process_usage.hpp"

#include <unistd.h>

#include <fstream>
#include <iterator>
#include <sstream>

namespace gvom::tools {

namespace {

std::string read_text(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

std::optional<std::uint64_t> cpu_ticks_of(const std::string& stat) {
  const std::size_t name_end = stat.rfind(')');  // a name may hold spaces and parentheses itself
  if (name_end == std::string::npos) return std::nullopt;
  std::istringstream fields(stat.substr(name_end + 1));
  std::string skipped;
  for (int i = 3; i <= 13; ++i) fields >> skipped;  // fields are counted from 1, the name is the second
  std::uint64_t user = 0;
  std::uint64_t system = 0;
  if (!(fields >> user >> system)) return std::nullopt;
  return user + system;
}

std::optional<std::uint64_t> memory_bytes_of(const std::string& status, const std::string& key) {
  std::istringstream lines(status);
  std::string line;
  while (std::getline(lines, line)) {
    if (line.compare(0, key.size() + 1, key + ":") != 0) continue;
    std::istringstream value(line.substr(key.size() + 1));
    std::uint64_t kilobytes = 0;
    if (!(value >> kilobytes)) return std::nullopt;
    return kilobytes * 1024;
  }
  return std::nullopt;
}

std::optional<Usage> read_usage(std::uint32_t pid) {
  const std::string folder = "/proc/" + std::to_string(pid);
  const auto ticks = cpu_ticks_of(read_text(folder + "/stat"));
  const std::string status = read_text(folder + "/status");
  const auto peak = memory_bytes_of(status, "VmHWM");  // a process that has just ended has none
  const auto own = memory_bytes_of(status, "RssAnon");
  if (!ticks || !peak || !own) return std::nullopt;
  return Usage{static_cast<double>(*ticks) / static_cast<double>(sysconf(_SC_CLK_TCK)), *peak, *own};
}

}  // namespace gvom::tools
