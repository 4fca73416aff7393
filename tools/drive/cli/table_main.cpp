// gvom-drive-table: the tables of campaigns from their rows, as Markdown, and what failed in them.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "tools/drive/cli/campaign.hpp"
#include "tools/drive/cli/table.hpp"

using namespace gvom::driving;

namespace {

void keep(std::uint64_t first_seed, std::uint64_t last_seed, std::vector<Figures>& figures) {
  const auto is_other = [&](const Figures& row) { return row.seed < first_seed || row.seed > last_seed; };
  figures.erase(std::remove_if(figures.begin(), figures.end(), is_other), figures.end());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Tables, as Markdown, of campaigns that gvom-drive --rows has left, named after their folders."};
  std::vector<std::string> paths;
  std::string seeds;
  app.add_option("rows", paths, "files of gvom-drive --rows")->required()->check(CLI::ExistingFile);
  app.add_option("--seeds", seeds, "only of these worlds: N, or FIRST..LAST");
  CLI11_PARSE(app, argc, argv);
  CampaignOptions wanted;
  if (!seeds.empty() && !read_seeds(seeds, wanted))
    return std::fprintf(stderr, "gvom-drive-table: --seeds: expected N or FIRST..LAST\n"), 64;

  std::vector<std::pair<std::string, Summary>> ours, benchmarks;
  std::string failures;
  for (const std::string& path : paths) {
    auto rows = read_rows(path);
    if (!rows) return std::fprintf(stderr, "gvom-drive-table: %s\n", rows.error().c_str()), 65;
    if (!seeds.empty()) keep(wanted.first_seed, wanted.last_seed, rows->figures);
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    ours.emplace_back(folder.filename(), summary_of(rows->figures));
    benchmarks.emplace_back(folder.filename(), benchmark_of(rows->figures));
    if (const std::string failed = failures_of(*rows, folder); !failed.empty())
      failures += "\n" + folder.filename().string() + ":\n" + failed;
  }
  std::printf("%s\n%s%s", markdown_of(ours).c_str(), markdown_of(benchmarks).c_str(), failures.c_str());
  return 0;
}
