#include "tools/drive/cli/rows_file.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "services/common/text_hash.hpp"

namespace gvom::driving {
namespace {

const std::string kOptions = "# options: ";
const std::string kVehicle = "# vehicle file: ";

std::string head_of(const Making& making) {
  return kOptions + making.options + "\n" + kVehicle + making.vehicle + "\n" + kFigureNames + "\n";
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Without a last line that has no end.
std::string whole_lines(std::string text) {
  const std::size_t end = text.rfind('\n');
  text.resize(end == std::string::npos ? 0 : end + 1);
  return text;
}

bool take(const std::string& line, const std::string& begin, std::string& rest) {
  if (line.compare(0, begin.size(), begin) != 0) return false;
  rest = line.substr(begin.size());
  return true;
}

}  // namespace

std::string hash_of_file(const std::string& path) {
  services::TextHash hash;
  hash.add(bytes_of(path));
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash.value()));
  return digits;
}

tl::expected<Rows, std::string> read_rows(const std::string& path) {
  std::istringstream lines(whole_lines(bytes_of(path)));
  Rows rows;
  std::string options, vehicle, line;
  std::getline(lines, options);
  std::getline(lines, vehicle);
  std::getline(lines, line);
  if (!take(options, kOptions, rows.making.options) || !take(vehicle, kVehicle, rows.making.vehicle) ||
      line != kFigureNames)
    return tl::unexpected(path + ": not a file of gvom-drive --rows");
  while (std::getline(lines, line)) {
    auto figures = read_figures(line);
    if (!figures) return tl::unexpected(path + ": " + figures.error());
    rows.figures.push_back(std::move(*figures));
  }
  return rows;
}

tl::expected<RowsFile, std::string> RowsFile::open(const std::string& path, const Making& making) {
  namespace fs = std::filesystem;
  RowsFile file(path);
  const fs::path folder = fs::path(path).parent_path();
  std::error_code error;
  if (!folder.empty()) fs::create_directories(folder, error);
  const std::string bytes = bytes_of(path), text = whole_lines(bytes);
  if (text.empty()) {
    if (!(std::ofstream(path, std::ios::binary) << head_of(making) << std::flush))
      return tl::unexpected(path + " cannot be written");
  } else {
    auto rows = read_rows(path);
    if (!rows) return tl::unexpected(rows.error());
    if (!(rows->making == making))
      return tl::unexpected(path + " was made by " + rows->making.options + " with a vehicle file " +
                            rows->making.vehicle + ", not by " + making.options + " with " + making.vehicle);
    file.figures_ = std::move(rows->figures);
    if (text.size() != bytes.size()) fs::resize_file(path, text.size(), error);
    if (error) return tl::unexpected(path + ": " + error.message());
  }
  return file;
}

std::set<std::uint64_t> RowsFile::seeds() const {
  std::set<std::uint64_t> seeds;
  for (const Figures& figures : figures_) seeds.insert(figures.seed);
  return seeds;
}

bool RowsFile::append(const Figures& figures) {
  figures_.push_back(figures);
  whole_ = whole_ && std::ofstream(path_, std::ios::app) << line_of(figures) + "\n" << std::flush;
  return whole_;
}

}  // namespace gvom::driving
