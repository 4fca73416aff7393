#include "tools/compare/folders.hpp"

#include <algorithm>
#include <filesystem>

#include "tools/compare/difference.hpp"

namespace gvom::compare {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kInFull = 4;    // differences
constexpr std::size_t kInShort = 30;  // a line each

// By their paths from the folder.
tl::expected<std::set<std::string>, std::string> arrays_below(const std::string& folder,
                                                              const std::set<std::string>& ignored) {
  std::set<std::string> names;
  std::error_code error;
  for (auto entry = fs::recursive_directory_iterator(folder, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const fs::path& path = entry->path();
    if (path.extension() == ".npy" && ignored.count(path.filename().string()) == 0)
      names.insert(path.lexically_relative(folder).generic_string());
  }
  if (error) return tl::unexpected(folder + ": " + error.message());
  return names;
}

std::string compare_files(const std::string& name, const std::string& expected, const std::string& found) {
  const auto due = npy::read_npy(expected + "/" + name);
  const auto is = npy::read_npy(found + "/" + name);
  if (!due) return due.error();
  if (!is) return is.error();
  return difference(name, view_of(*due), view_of(*is));
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

}  // namespace

tl::expected<FolderComparison, std::string> compare_folders(const std::string& expected,
                                                            const std::string& found,
                                                            const std::set<std::string>& ignored) {
  const auto due = arrays_below(expected, ignored);
  if (!due) return tl::unexpected(due.error());
  const auto present = arrays_below(found, ignored);
  if (!present) return tl::unexpected(present.error());
  FolderComparison result;
  result.arrays = due->size();
  std::set<std::string> all = *due;
  all.insert(present->begin(), present->end());
  for (const std::string& name : all) {
    std::string words;
    if (present->count(name) == 0)
      words = name + ": is missing";
    else if (due->count(name) == 0)
      words = name + ": was not expected";
    else
      words = compare_files(name, expected, found);
    if (!words.empty()) result.differences.push_back(std::move(words));
  }
  return result;
}

std::string report(const FolderComparison& comparison) {
  const std::vector<std::string>& differences = comparison.differences;
  if (differences.empty()) return std::to_string(comparison.arrays) + " arrays, the same byte for byte\n";
  std::string all = std::to_string(differences.size()) + " of " + std::to_string(comparison.arrays) +
                    " arrays are not as expected\n";
  const std::size_t shown = std::min(differences.size(), kInFull + kInShort);
  for (std::size_t i = 0; i < shown; ++i)
    all += (i < kInFull ? differences[i] : first_line(differences[i])) + "\n";
  if (shown < differences.size()) all += "... and " + std::to_string(differences.size() - shown) + " more\n";
  return all;
}

}  // namespace gvom::compare
