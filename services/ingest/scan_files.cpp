#include "services/ingest/scan_files.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>

#include "services/common/stamps.hpp"

namespace gvom::ingest {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kNominalPeriodNs = 100'000'000;
constexpr std::int64_t kLongPeriodNs = 10'000'000'000;

using Paths = std::vector<fs::path>;

Paths files_with(const fs::path& folder, const std::string& extension) {
  Paths files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    const bool hidden = it->path().filename().string().front() == '.';
    if (!hidden && it->path().extension() == extension && it->is_regular_file(ignored))
      files.push_back(it->path());
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return in_natural_order(a.filename().string(), b.filename().string());
  });
  return files;
}

tl::expected<Paths, std::string> scans_in(const fs::path& folder) {
  auto bins = files_with(folder, ".bin");
  auto pcds = files_with(folder, ".pcd");
  if (!bins.empty() && !pcds.empty()) return tl::unexpected(folder.string() + ": holds .bin and .pcd files");
  return bins.empty() ? pcds : bins;
}

/// `folder` itself or the one under it that holds the scans.
tl::expected<fs::path, std::string> folder_of_scans(const fs::path& folder) {
  const auto own = scans_in(folder);
  if (!own) return tl::unexpected(own.error());
  if (!own->empty()) return folder;
  Paths found;
  for (const char* below : {"velodyne", "velodyne_points/data", "data"}) {
    const auto scans = scans_in(folder / below);
    if (!scans) return tl::unexpected(scans.error());
    if (!scans->empty()) found.push_back(folder / below);
  }
  if (found.size() == 1) return found[0];
  if (found.empty()) {
    return tl::unexpected(
        folder.string() +
        ": no .bin or .pcd files, nor in velodyne/, velodyne_points/data/ or data/ under it");
  }
  return tl::unexpected(folder.string() + ": both " + found[0].string() + " and " + found[1].string() +
                        " hold scans: name one of them");
}

Paths times_in(const fs::path& folder) {
  Paths found;
  std::error_code ignored;
  for (const char* name : {"times.txt", "timestamps.txt"}) {
    if (fs::exists(folder / name, ignored)) found.push_back(folder / name);
  }
  return found;
}

/// The file of the times of the scans in `folder`, if there is one.
tl::expected<std::optional<fs::path>, std::string> find_times(const fs::path& folder,
                                                              std::vector<std::string>& warnings) {
  std::error_code ignored;
  fs::path here = fs::absolute(folder, ignored).lexically_normal();
  if (!here.has_filename()) here = here.parent_path();  // a '/' at the end
  Paths found = times_in(folder);
  const Paths above = times_in(here.parent_path());
  const std::string name = here.filename().string();
  const bool may_be_above = name == "velodyne" || name == "velodyne_points" || name == "data";
  if (found.empty() && may_be_above) found = above;
  if (found.size() > 1) {
    return tl::unexpected(found[0].string() + " and " + found[1].string() +
                          ": which has the times of the scans? Leave one");
  }
  if (!found.empty()) return found[0];
  if (!above.empty()) {
    warnings.push_back(above[0].string() + ": not used: it is not in the folder of the scans, " +
                       folder.string());
  }
  return std::nullopt;
}

std::string names_of(const std::vector<ScanFile>& scans) {
  const std::string first = scans.front().path;
  return scans.size() == 1 ? first : first + " .. " + fs::path(scans.back().path).filename().string();
}

void warn_of_long_periods(const fs::path& path, const std::vector<ScanFile>& scans,
                          std::vector<std::string>& warnings) {
  const std::int64_t span_ns = scans.back().stamp_ns - scans.front().stamp_ns;
  const auto periods = static_cast<std::int64_t>(scans.size()) - 1;
  if (periods == 0 || span_ns / periods <= kLongPeriodNs) return;
  warnings.push_back(path.string() + ": scans are " + std::to_string(span_ns / periods / 1'000'000'000) +
                     " s apart: are its times in seconds?");
}

tl::expected<void, std::string> read_times(const fs::path& path, std::vector<ScanFile>& scans,
                                           std::vector<std::string>& warnings) {
  const auto times = services::read_stamps(path.string());
  if (!times) return tl::unexpected(times.error());
  if (times->size() != scans.size()) {
    return tl::unexpected(
        path.string() + ": " + std::to_string(times->size()) + " times for " + std::to_string(scans.size()) +
        " scans, " + names_of(scans) +
        (times->size() < scans.size()
             ? ": none for " + scans[times->size()].path
             : ": line " + std::to_string((*times)[scans.size()].line) + " is one too many"));
  }
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans[i].stamp_ns = (*times)[i].stamp_ns;
    if (i > 0 && scans[i].stamp_ns <= scans[i - 1].stamp_ns) {
      return tl::unexpected(path.string() + ":" + std::to_string((*times)[i].line) +
                            ": time does not go forward");
    }
  }
  warn_of_long_periods(path, scans, warnings);
  return {};
}

/// `all` lie in `folder`.
tl::expected<std::vector<ScanFile>, std::string> with_stamps(const Paths& all, const fs::path& folder,
                                                             std::vector<std::string>& warnings) {
  std::vector<ScanFile> scans;
  for (std::size_t i = 0; i < all.size(); ++i)
    scans.push_back({all[i].string(), static_cast<std::int64_t>(i) * kNominalPeriodNs});
  const auto times = find_times(folder, warnings);
  if (!times) return tl::unexpected(times.error());
  if (!*times) {
    warnings.push_back(folder.string() + ": no times.txt or timestamps.txt: stamps are 0.1 s apart, from 0");
    return scans;
  }
  const auto read = read_times(**times, scans, warnings);
  if (!read) return tl::unexpected(read.error());
  return scans;
}

tl::expected<std::vector<ScanFile>, std::string> only_scan(const fs::path& file,
                                                           std::vector<std::string>& warnings) {
  const auto extension = file.extension();
  if (extension != ".bin" && extension != ".pcd")
    return tl::unexpected(file.string() + ": neither a .bin nor a .pcd file");
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const auto times = find_times(folder, warnings);
  if (!times) return tl::unexpected(times.error());
  if (!*times) {
    warnings.push_back(file.string() + ": one scan without a times.txt, its stamp is 0");
    return std::vector<ScanFile>{{file.string(), 0}};
  }
  const auto scans = with_stamps(files_with(folder, extension.string()), folder, warnings);
  if (!scans) return scans;
  for (const ScanFile& scan : *scans) {
    if (fs::path(scan.path).filename() == file.filename())
      return std::vector<ScanFile>{{file.string(), scan.stamp_ns}};
  }
  return tl::unexpected(file.string() + ": is not among the scans of its folder");
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The digits that `text` begins with, taken off it.
std::string_view take_number(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  const std::string_view number = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(number.size());
  return number;
}

std::string_view without_zeros(std::string_view number) {
  return number.substr(std::min(number.find_first_not_of('0'), number.size()));
}

}  // namespace

bool in_natural_order(const std::string& a, const std::string& b) {
  std::string_view left = a, right = b;
  while (!left.empty() && !right.empty()) {
    if (!is_digit(left[0]) || !is_digit(right[0])) {
      if (left[0] != right[0]) return left[0] < right[0];
      left.remove_prefix(1);
      right.remove_prefix(1);
      continue;
    }
    const std::string_view x = without_zeros(take_number(left)), y = without_zeros(take_number(right));
    if (x.size() != y.size()) return x.size() < y.size();
    if (x != y) return x < y;
  }
  if (left.empty() != right.empty()) return left.empty();
  return a < b;  // the same but for zeros in front
}

tl::expected<std::vector<ScanFile>, std::string> list_scans(const std::string& path,
                                                            std::vector<std::string>& warnings) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (!fs::exists(status)) return tl::unexpected(path + ": no such file or folder");
  if (!fs::is_directory(status)) return only_scan(path, warnings);
  const auto folder = folder_of_scans(path);
  if (!folder) return tl::unexpected(folder.error());
  const auto scans = scans_in(*folder);
  if (!scans) return tl::unexpected(scans.error());
  return with_stamps(*scans, *folder, warnings);
}

}  // namespace gvom::ingest
