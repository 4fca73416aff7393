#include <utility>

#include "services/common/bag/bag_file.hpp"
#include "services/common/bag/zstd_unpack.hpp"

namespace gvom::bag {
namespace {

const std::string kPacked = ".zstd";

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string without_packing(const std::string& path) {
  return ends_with(path, kPacked) ? path.substr(0, path.size() - kPacked.size()) : path;
}

FileResult open_unpacked(const std::string& path, const std::string& name) {
  return ends_with(without_packing(name), ".mcap") ? open_mcap(path, name) : open_db3(path, name);
}

/// Adds what was wrong with the packing to what is wrong with the file.
class PackedFile final : public BagFile {
 public:
  PackedFile(std::unique_ptr<BagFile> file, std::vector<std::string> warnings)
      : file_(std::move(file)), packing_(warnings.size()), warnings_(std::move(warnings)) {
    note_warnings();
  }

  [[nodiscard]] const std::vector<FileTopic>& topics() const override { return file_->topics(); }
  [[nodiscard]] std::int64_t first_ns() const override { return file_->first_ns(); }
  [[nodiscard]] std::int64_t last_ns() const override { return file_->last_ns(); }
  tl::expected<void, std::string> select(const std::set<std::size_t>& topics) override {
    return file_->select(topics);
  }
  tl::expected<bool, std::string> next(FileMessage& out) override {
    auto more = file_->next(out);
    note_warnings();
    return more;
  }
  [[nodiscard]] std::uint64_t damaged() const override { return file_->damaged() + packing_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return warnings_; }

 private:
  void note_warnings() {
    while (noted_ < file_->warnings().size()) warnings_.push_back(file_->warnings()[noted_++]);
  }

  std::unique_ptr<BagFile> file_;
  std::uint64_t packing_;
  std::vector<std::string> warnings_;
  std::size_t noted_ = 0;
};

}  // namespace

bool is_bag_file(const std::string& path) {
  const std::string name = without_packing(path);
  return ends_with(name, ".db3") || ends_with(name, ".mcap");
}

FileResult open_bag_file(const std::string& path) {
  if (!is_bag_file(path))
    return tl::unexpected(path + ": its name ends with neither .db3 nor .mcap (nor .zstd behind these)");
  if (!ends_with(path, kPacked)) return open_unpacked(path, path);
  std::vector<std::string> warnings;
  const auto unpacked = unpack_file(path, warnings);
  if (!unpacked) return tl::unexpected(unpacked.error());
  auto file = open_unpacked(unpacked->path(), path);  // stays open when its name goes
  if (!file) return file;
  return std::make_unique<PackedFile>(std::move(*file), std::move(warnings));
}

}  // namespace gvom::bag
