// A folder of one scan, .bin or .pcd, with or without times.txt. First byte: bit 0 .pcd, bit 1 times; then,
// with times, their length (two bytes) and they themselves; the rest is the scan.
#include <filesystem>
#include <fstream>

#include "services/ingest/scan_source.hpp"
#include "tests/fuzz/input.hpp"

using namespace gvom;
using namespace gvom::fuzz;

namespace {

/// In memory, gone at the end.
class Folder {
 public:
  Folder() {
    char name[] = "/dev/shm/gvom-fuzz-XXXXXX";
    require(::mkdtemp(name) != nullptr, "a folder can be made");
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  void write(const char* name, ingest::Bytes bytes) const {
    std::ofstream(path_ + name, std::ios::binary) << text_of(bytes);
  }
  void remove(const char* name) const { std::filesystem::remove(path_ + name); }

 private:
  std::string path_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  constexpr std::size_t kMaxReturns = 100;
  Input input(data, size);
  const std::uint8_t how = input.byte();
  const char* name = (how & 1) != 0 ? "/a.pcd" : "/a.bin";
  if ((how & 2) != 0) folder.write("/times.txt", input.take(input.value<std::uint16_t>()));
  folder.write(name, input.rest());
  auto source = ingest::ScanSource::open(folder.path(), {0.0, kMaxReturns}, {});
  for (int round = 0; source && round < 2; ++round) {
    Sweep sweep;
    const auto event = (*source)->next(sweep, std::chrono::milliseconds(0));
    if (event && *event == ingest::SourceEvent::kSweep) check_sweep(sweep, kMaxReturns);
    require((*source)->rewind().has_value(), "scans can be read again");
  }
  folder.remove(name);
  folder.remove("/times.txt");
  return 0;
}
