// gvom-drive-table: the tables of campaigns from their rows, as Markdown, and what failed in them.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "tools/drive/cli/table.hpp"

using namespace gvom::driving;

int main(int argc, char** argv) {
  CLI::App app{
      "Tables, as Markdown, of campaigns that gvom-drive --rows has left, named after their folders."};
  std::vector<std::string> paths;
  app.add_option("rows", paths, "files of gvom-drive --rows")->required()->check(CLI::ExistingFile);
  CLI11_PARSE(app, argc, argv);

  std::vector<std::pair<std::string, Summary>> ours, benchmarks;
  std::string failures;
  for (const std::string& path : paths) {
    const auto rows = read_rows(path);
    if (!rows) return std::fprintf(stderr, "gvom-drive-table: %s\n", rows.error().c_str()), 65;
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    ours.emplace_back(folder.filename(), summary_of(rows->figures));
    benchmarks.emplace_back(folder.filename(), benchmark_of(rows->figures));
    if (const std::string failed = failures_of(*rows, folder); !failed.empty())
      failures += "\n" + folder.filename().string() + ":\n" + failed;
  }
  std::printf("%s\n%s%s", markdown_of(ours).c_str(), markdown_of(benchmarks).c_str(), failures.c_str());
  return 0;
}
