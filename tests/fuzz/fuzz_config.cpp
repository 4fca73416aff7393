// Vehicle files and --set arguments, which stand behind the file, each behind a zero byte. What loads prints
// as a file that loads to the same.
#include <sstream>

#include "services/common/config_file.hpp"
#include "tests/fuzz/memory_file.hpp"

using namespace gvom;
using namespace gvom::fuzz;

namespace {

std::string printed(const services::VehicleConfig& config) {
  std::ostringstream out;
  services::print_config(config, out);
  return out.str();
}

void check_round_trip(const services::VehicleConfig& config) {
  static const MemoryFile file;
  const std::string text = printed(config);
  file.set(text);
  const auto again = services::load_vehicle_config(file.path());
  if (!again) std::fprintf(stderr, "%s\n%s", again.error().text().c_str(), text.c_str());
  require(again.has_value(), "a printed configuration loads");
  require(printed(*again) == text, "and prints the same");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MemoryFile file;
  std::istringstream parts(std::string(reinterpret_cast<const char*>(data), size));
  std::string text;
  std::getline(parts, text, '\0');
  std::vector<std::string> sets;
  for (std::string set; sets.size() < 8 && std::getline(parts, set, '\0');) sets.push_back(set);
  file.set(text);
  const auto config = services::load_vehicle_config(file.path(), sets);
  require(config || !config.error().message.empty(), "an error says what it is");
  constexpr std::size_t kOneIn = 8;  // it takes ten times as long as the rest
  if (config && size % kOneIn == 0) check_round_trip(*config);
  return 0;
}
