#include "tools/endurance/process_sample.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "tools/common/process_usage.hpp"

namespace gvom::endurance {

namespace {

std::string read_text(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::uint64_t number_after(const std::string& text, const std::string& key) {
  const std::size_t at = text.find("\n" + key + ":");
  return at == std::string::npos ? 0 : std::strtoull(text.c_str() + at + key.size() + 2, nullptr, 10);
}

std::uint64_t entries(const std::string& folder) {
  std::error_code failure;
  const std::filesystem::directory_iterator all(folder, failure);
  return failure ? 0 : static_cast<std::uint64_t>(std::distance(begin(all), end(all)));
}

void add_switches(const std::string& folder, ProcessSample& sample) {
  std::error_code failure;
  for (const auto& thread : std::filesystem::directory_iterator(folder + "/task", failure)) {
    const std::string status = read_text(thread.path().string() + "/status");
    sample.voluntary_switches += number_after(status, "voluntary_ctxt_switches");
    sample.involuntary_switches += number_after(status, "nonvoluntary_ctxt_switches");
    ++sample.threads;
  }
}

/// minflt and majflt, the tenth and the twelfth field.
void add_faults(const std::string& stat, ProcessSample& sample) {
  const std::size_t name_end = stat.rfind(')');
  if (name_end == std::string::npos) return;
  std::istringstream fields(stat.substr(name_end + 1));
  std::string skipped;
  for (int i = 3; i <= 9; ++i) fields >> skipped;
  fields >> sample.minor_faults >> skipped >> sample.major_faults;
}

}  // namespace

std::optional<ProcessSample> sample_process(pid_t pid) {
  const std::string folder = "/proc/" + std::to_string(pid);
  const std::string status = read_text(folder + "/status");
  const std::string stat = read_text(folder + "/stat");
  const auto own = tools::memory_bytes_of(status, "RssAnon");
  const auto ticks = tools::cpu_ticks_of(stat);
  if (!own || !ticks) return std::nullopt;
  ProcessSample sample{};
  sample.private_bytes = *own;
  sample.locked_bytes = tools::memory_bytes_of(status, "VmLck").value_or(0);
  sample.descriptors = entries(folder + "/fd");
  add_switches(folder, sample);
  add_faults(stat, sample);
  sample.cpu_s = static_cast<double>(*ticks) / static_cast<double>(::sysconf(_SC_CLK_TCK));
  return sample;
}

}  // namespace gvom::endurance
