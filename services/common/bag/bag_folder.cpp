#include "services/common/bag/bag_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "services/common/bag/bag_file.hpp"

namespace gvom::bag {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostMetadataBytes = 16 << 20;
const std::string kBlanksAndQuotes = " \t\r\"'";

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(kBlanksAndQuotes);
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(kBlanksAndQuotes) + 1 - begin);
}

/// Names of its files, without the folder that old recorders put in front. Nothing if there is no such file.
std::set<std::string> read_metadata(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kMostMetadataBytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  std::set<std::string> names;
  for (const std::string& listed : listed_files(text)) names.insert(fs::path(listed).filename().string());
  return names;
}

std::set<std::string> files_in(const fs::path& folder, bool& has_ros1) {
  std::set<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    has_ros1 = has_ros1 || it->path().extension() == ".bag";
    std::error_code ignored;
    if (is_bag_file(name) && it->is_regular_file(ignored)) names.insert(name);
  }
  return names;
}

/// Of a file that is there packed and unpacked one is enough.
void drop_packed_twins(std::set<std::string>& names) {
  for (auto it = names.begin(); it != names.end();) {
    const std::size_t dot = it->rfind(".zstd");
    const bool twin = dot != std::string::npos && names.count(it->substr(0, dot)) != 0;
    it = twin ? names.erase(it) : std::next(it);
  }
}

void compare(const std::string& folder, const std::set<std::string>& listed,
             const std::set<std::string>& found, std::vector<std::string>& warnings) {
  if (listed.empty()) {
    warnings.push_back(
        folder + ": no metadata.yaml that names files (was its recorder killed?): all its files are read");
    return;
  }
  for (const std::string& name : listed)
    if (found.count(name) == 0)
      warnings.push_back(folder + ": metadata.yaml names " + name + ", which is not there");
  for (const std::string& name : found)
    if (listed.count(name) == 0)
      warnings.push_back(folder + ": " + name + " is not in metadata.yaml, and read too");
}

}  // namespace

std::vector<std::string> listed_files(const std::string& metadata) {
  std::vector<std::string> out;
  std::istringstream lines(metadata);
  bool listing = false;
  for (std::string line; std::getline(lines, line);) {
    const std::string text = trimmed(line);
    if (listing && text.compare(0, 2, "- ") == 0) {
      out.push_back(trimmed(text.substr(2)));
    } else if (!text.empty()) {
      listing = text == "relative_file_paths:";
    }
  }
  return out;
}

tl::expected<std::vector<std::string>, std::string> bag_files(const std::string& path,
                                                              std::vector<std::string>& warnings) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    return tl::unexpected(path + ": " + (error ? error.message() : "no such file or folder"));
  if (!fs::is_directory(status)) return std::vector<std::string>{path};
  bool has_ros1 = false;
  std::set<std::string> found = files_in(path, has_ros1);
  if (found.empty()) {
    return tl::unexpected(path + (has_ros1 ? ": is a bag of ROS 1: convert it first (rosbags-convert)"
                                           : ": is no bag: has neither .db3 nor .mcap files"));
  }
  compare(path, read_metadata(fs::path(path) / "metadata.yaml"), found, warnings);
  drop_packed_twins(found);
  std::vector<std::string> paths;
  for (const std::string& name : found) paths.push_back((fs::path(path) / name).string());
  return paths;
}

}  // namespace gvom::bag
