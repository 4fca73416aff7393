// A campaign's rows in a file that grows as its drives end, so that one that was cut goes on.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/drive/cli/figures.hpp"

namespace gvom::driving {

/// By what the rows of a file were made. Rows of different makings are never in one file.
struct Making {
  std::string options;  ///< Of gvom-drive, without seeds, threads and folders.
  std::string vehicle;  ///< A hash of the vehicle's file.

  [[nodiscard]] bool operator==(const Making& other) const {
    return options == other.options && vehicle == other.vehicle;
  }
};

/// FNV-1a of a file's bytes, as hexadecimal digits; of one that cannot be read, that of nothing.
std::string hash_of_file(const std::string& path);

struct Rows {
  Making making;
  std::vector<Figures> figures;  ///< In the order of the file.
};

/// A last line that was cut does not count. Errors name the file.
tl::expected<Rows, std::string> read_rows(const std::string& path);

class RowsFile {
 public:
  /// Goes on with a file of the same making, or begins one. The error says how another one's differs.
  static tl::expected<RowsFile, std::string> open(const std::string& path, const Making& making);

  [[nodiscard]] std::set<std::uint64_t> seeds() const;
  [[nodiscard]] const std::vector<Figures>& figures() const { return figures_; }
  /// False: it could not be written, nor can any after it: a line may be cut there.
  bool append(const Figures& figures);

 private:
  explicit RowsFile(std::string path) : path_(std::move(path)) {}

  std::string path_;
  std::vector<Figures> figures_;
  bool whole_ = true;
};

}  // namespace gvom::driving
