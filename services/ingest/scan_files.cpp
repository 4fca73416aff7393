#include "services/ingest/scan_files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include "services/common/tum.hpp"

namespace gvom::ingest {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kNominalPeriodNs = 100'000'000;
constexpr std::int64_t kMaxStampNs = 4'000'000'000'000'000'000;  // leaves room to add a time within the sweep

std::vector<fs::path> files_with(const fs::path& folder, const std::string& extension) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    if (it->path().extension() == extension && it->is_regular_file(ignored)) files.push_back(it->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

tl::expected<std::vector<fs::path>, std::string> scans_in(const fs::path& folder) {
  auto bins = files_with(folder, ".bin");
  auto pcds = files_with(folder, ".pcd");
  if (!bins.empty() && !pcds.empty()) return tl::unexpected(folder.string() + ": holds .bin and .pcd files");
  return bins.empty() ? pcds : bins;
}

std::optional<fs::path> find_times(fs::path folder) {
  std::error_code ignored;
  if (!folder.has_filename()) folder = folder.parent_path();  // a '/' at the end
  if (fs::exists(folder / "times.txt", ignored)) return folder / "times.txt";
  const fs::path above = fs::absolute(folder, ignored).lexically_normal();
  const bool called_velodyne = above.filename() == "velodyne";
  const fs::path there = above.parent_path() / "times.txt";
  if (called_velodyne && fs::exists(there, ignored)) return there;
  return std::nullopt;
}

tl::expected<void, std::string> read_times(const fs::path& path, std::vector<ScanFile>& scans) {
  std::ifstream file(path);
  if (!file) return tl::unexpected(path.string() + ": cannot be read");
  std::size_t count = 0;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::string where = path.string() + ":" + std::to_string(number) + ": ";
    const auto end = line.find_last_not_of(" \t\r");
    if (end == std::string::npos) continue;
    const auto stamp = services::parse_stamp_ns(std::string_view(line).substr(0, end + 1));
    if (!stamp || *stamp > kMaxStampNs || *stamp < -kMaxStampNs)
      return tl::unexpected(where + "'" + line + "' is not a time in seconds");
    if (count == scans.size()) {
      return tl::unexpected(where + "a time too many: there are " + std::to_string(count) + " scans");
    }
    if (count > 0 && *stamp <= scans[count - 1].stamp_ns)
      return tl::unexpected(where + "time does not go forward");
    scans[count++].stamp_ns = *stamp;
  }
  if (count == scans.size()) return {};
  return tl::unexpected(path.string() + ": " + std::to_string(count) + " times for " +
                        std::to_string(scans.size()) + " scans, none for " + scans[count].path);
}

tl::expected<std::vector<ScanFile>, std::string> scans_of_folder(fs::path folder,
                                                                 std::vector<std::string>& warnings) {
  auto files = scans_in(folder);
  if (files && files->empty()) {
    folder /= "velodyne";
    files = scans_in(folder);
  }
  if (!files) return tl::unexpected(files.error());
  if (files->empty()) {
    return tl::unexpected(folder.parent_path().string() +
                          ": no .bin or .pcd files, nor in velodyne/ under it");
  }
  std::vector<ScanFile> scans;
  for (std::size_t i = 0; i < files->size(); ++i) {
    scans.push_back({(*files)[i].string(), static_cast<std::int64_t>(i) * kNominalPeriodNs});
  }
  const auto times = find_times(folder);
  if (!times) {
    warnings.push_back(folder.string() + ": no times.txt: stamps are 0.1 s apart, from 0");
    return scans;
  }
  const auto read = read_times(*times, scans);
  if (!read) return tl::unexpected(read.error());
  return scans;
}

}  // namespace

tl::expected<std::vector<ScanFile>, std::string> list_scans(const std::string& path,
                                                            std::vector<std::string>& warnings) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (fs::is_directory(status)) return scans_of_folder(path, warnings);
  if (!fs::exists(status)) return tl::unexpected(path + ": no such file or folder");
  const auto extension = fs::path(path).extension();
  if (extension != ".bin" && extension != ".pcd")
    return tl::unexpected(path + ": neither a .bin nor a .pcd file");
  warnings.push_back(path + ": one scan, its stamp is 0");
  return std::vector<ScanFile>{{path, 0}};
}

}  // namespace gvom::ingest
