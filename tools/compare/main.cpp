// gvom-compare: are the maps in two folders the same, and if not, what differs?
#include <CLI/CLI.hpp>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include "services/common/exit_code.hpp"
#include "tools/compare/folders.hpp"

namespace {

using gvom::services::ExitCode;

int fail(const std::string& message) {
  std::fprintf(stderr, "gvom-compare: %s\n", message.c_str());
  return to_int(ExitCode::bad_data);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Compares two folders that gvom-map wrote, every .npy array byte for byte: which differ, in how many "
      "values, "
      "and the first ten of these, floats with their bits. Exit code 0 if they are the same, 1 if not.",
      "gvom-compare");
  app.set_version_flag("--version", std::string("gvom-compare ") + GVOM_VERSION);
  std::string expected, found;
  std::vector<std::string> ignored;
  app.add_option("EXPECTED", expected, "folder with what is expected")->required();
  app.add_option("FOUND", found, "folder with what was found")->required();
  app.add_option("--ignore", ignored, "arrays of this name are left out")->type_name("NAME.npy");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return to_int(app.exit(error) == 0 ? ExitCode::ok : ExitCode::usage);
  }
  const auto comparison =
      gvom::compare::compare_folders(expected, found, std::set<std::string>(ignored.begin(), ignored.end()));
  if (!comparison) return fail(comparison.error());
  if (comparison->arrays == 0) return fail(expected + ": no arrays");
  std::fputs(report(*comparison).c_str(), stdout);
  return comparison->differences.empty() ? 0 : 1;
}
