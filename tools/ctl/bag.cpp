// gvomctl bag: what is in a bag, and what a vehicle's file must say to map it.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "services/common/stamps.hpp"
#include "tools/ctl/bag_facts.hpp"
#include "tools/ctl/bag_report.hpp"
#include "tools/ctl/commands.hpp"

namespace gvom::ctl {
namespace {

using services::ExitCode;

void print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
}

/// The newest metadata of each Ouster in the bag, as its sources' `meta` reads it.
int write_metadata(const BagFacts& facts, const std::string& folder) {
  int files = 0;
  for (const BagTopicFacts& topic : facts.topics) {
    if (topic.metadata.empty()) continue;
    const std::string path = folder + "/" + metadata_file(topic);
    std::ofstream file(path);
    file << topic.metadata;
    if (!file.flush()) {
      std::fprintf(stderr, "%s: cannot be written\n", path.c_str());
      return to_int(ExitCode::unavailable);
    }
    print(fmt::format("wrote {}\n", path));
    ++files;
  }
  if (files > 0) return to_int(ExitCode::ok);
  std::fprintf(stderr, "%s: has no topic with an Ouster's metadata\n", facts.path.c_str());
  return to_int(ExitCode::bad_data);
}

}  // namespace

int show_bag(const std::string& path, const std::string& metadata_folder) {
  const auto facts = read_bag_facts(path);
  if (!facts) {
    std::fprintf(stderr, "%s\n", facts.error().c_str());
    return to_int(ExitCode::bad_data);
  }
  for (const std::string& warning : facts->warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (!metadata_folder.empty()) return write_metadata(*facts, metadata_folder);
  print(fmt::format("{}: from {} s for {} s, by the recorder\n\n", path,
                    services::stamp_text(facts->log.first_ns),
                    services::stamp_text(facts->log.last_ns - facts->log.first_ns)));
  print(bag_table(*facts));
  const auto problems = bag_problems(*facts);
  if (!problems.empty()) print("\n");
  for (const std::string& problem : problems) print("  " + problem + "\n");
  const auto& topics = facts->topics;
  if (std::any_of(topics.begin(), topics.end(),
                  [](const BagTopicFacts& topic) { return !topic.metadata.empty(); }))
    print("\n  it has an Ouster's metadata: --metadata FOLDER writes the files\n");
  print("\nA vehicle's file for `gvom-map --config FILE --bag " + path + " --out maps`:\n\n" +
        vehicle_lines(*facts));
  return to_int(ExitCode::ok);
}

}  // namespace gvom::ctl
