// Where pictures go: one folder, the newest under plain names.
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "tools/snapshot/picture.hpp"

namespace gvom::snapshot {

struct OutputOptions {
  std::string folder;
  bool numbered = false;  ///< Keep every montage as NNNNNN-montage.png too.
  bool npy = false;       ///< Every snapshot's arrays in NNNNNN/.
};

class Output {
 public:
  /// Makes the folder. Errors name it.
  static tl::expected<Output, std::string> open(const OutputOptions& options);

  /// Writes montage.png, overview.png, ground.png, <layer>.png and what the options ask for. Each picture
  /// appears whole or not at all. Errors name the file.
  tl::expected<void, std::string> write(const LayersPicture& picture);

  [[nodiscard]] int written() const { return written_; }
  [[nodiscard]] const std::string& folder() const { return options_.folder; }

 private:
  explicit Output(OutputOptions options) : options_(std::move(options)) {}
  OutputOptions options_;
  int written_ = 0;
};

}  // namespace gvom::snapshot
