#include "services/ingest/scan_source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <utility>

#include "services/ingest/bytes.hpp"

namespace gvom::ingest {
namespace {

constexpr std::size_t kBinPoint = 16;   // float32 x, y, z, intensity
constexpr double kAbsoluteFromS = 1e8;  // a larger time is one of the clock, not of the sweep
constexpr double kMaxTimeS = 4e9;

/// The time of a point, as the file has it, in ns; nothing if it is not one.
std::optional<std::int64_t> read_time_ns(const PcdCloud& cloud, const PcdField& field, std::size_t point) {
  if (field.type != 'F') {
    const std::int64_t time_ns = cloud.integer(field, point);
    if (static_cast<double>(time_ns) < -kMaxTimeS * 1e9 || static_cast<double>(time_ns) > kMaxTimeS * 1e9)
      return std::nullopt;
    return time_ns;
  }
  const double time_s = cloud.number(field, point);
  if (!(std::abs(time_s) <= kMaxTimeS)) return std::nullopt;
  return std::llround(time_s * 1e9);
}

const PcdField* find_time_field(const PcdCloud& cloud) {
  for (const char* name : {"t", "time", "timestamp", "time_offset", "offset_time"}) {
    if (const PcdField* field = cloud.find(name)) return field;
  }
  return nullptr;
}

}  // namespace

tl::expected<std::unique_ptr<Source>, std::string> ScanSource::open(const std::string& path,
                                                                    const SourceOptions& options) {
  SourceState state;
  auto scans = list_scans(path, state.warnings);
  if (!scans) return tl::unexpected(scans.error());
  return std::unique_ptr<Source>(new ScanSource(std::move(*scans), options, std::move(state)));
}

ScanSource::ScanSource(std::vector<ScanFile> scans, const SourceOptions& options, SourceState state)
    : scans_(std::move(scans)), max_returns_(options.max_returns), state_(std::move(state)) {
  std::uintmax_t largest = 0;
  for (const ScanFile& scan : scans_) {
    std::error_code error;
    const auto size = std::filesystem::file_size(scan.path, error);
    if (!error) largest = std::max(largest, size);
  }
  file_.reserve(largest);
}

tl::expected<SourceEvent, std::string> ScanSource::next(Sweep& out, std::chrono::milliseconds) {
  out.clear();
  out.returns.reserve(max_returns_);
  if (index_ == scans_.size()) return SourceEvent::kEnd;
  const ScanFile& scan = scans_[index_++];
  auto done = read_file(scan.path);
  const bool bin = scan.path.compare(scan.path.size() - 4, 4, ".bin") == 0;
  if (done) done = bin ? read_bin(scan, out) : read_pcd(scan, out);
  if (!done) {
    out.clear();
    index_ = scans_.size();
    return tl::unexpected(scan.path + ": " + done.error());
  }
  ++state_.counters.sweeps;
  return SourceEvent::kSweep;
}

tl::expected<void, std::string> ScanSource::rewind() {
  index_ = 0;
  return {};
}

/// Plain system calls: a stream would allocate its buffer for each file.
tl::expected<void, std::string> ScanSource::read_file(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return tl::unexpected(std::string(std::strerror(errno)));
  struct stat status {};
  ::fstat(file, &status);
  file_.resize(static_cast<std::size_t>(status.st_size));
  std::size_t done = 0;
  ssize_t got = 1;
  while (got > 0 && done < file_.size()) {
    got = ::read(file, file_.data() + done, file_.size() - done);
    if (got > 0) done += static_cast<std::size_t>(got);
  }
  ::close(file);
  if (done < file_.size()) return tl::unexpected(std::string("cannot be read to its end"));
  return {};
}

/// How many of the points are taken; the rest is counted.
std::size_t ScanSource::limit(std::size_t points) {
  const std::size_t taken = std::min(points, max_returns_);
  state_.counters.overflow_returns += points - taken;
  return taken;
}

tl::expected<void, std::string> ScanSource::read_bin(const ScanFile& scan, Sweep& out) {
  if (file_.size() % kBinPoint != 0) {
    return tl::unexpected("its size of " + std::to_string(file_.size()) + " bytes is not a multiple of 16");
  }
  out.times_ns.push_back(scan.stamp_ns);
  out.stamp_ns = scan.stamp_ns;
  const std::size_t count = limit(file_.size() / kBinPoint);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* point = file_.data() + i * kBinPoint;
    out.returns.push_back({load_le<float>(point), load_le<float>(point + 4), load_le<float>(point + 8), 0});
  }
  return {};
}

tl::expected<void, std::string> ScanSource::read_pcd(const ScanFile& scan, Sweep& out) {
  const auto cloud = parse_pcd({file_.data(), file_.size()}, unpacked_);
  if (!cloud) return tl::unexpected(cloud.error());
  const PcdField* const axes[3] = {cloud->find("x"), cloud->find("y"), cloud->find("z")};
  for (const PcdField* axis : axes) {
    if (axis == nullptr || axis->type != 'F')
      return tl::unexpected(std::string("no floating-point fields x, y, z"));
  }
  const std::size_t count = limit(cloud->points);
  const PcdField* time_field = find_time_field(*cloud);
  point_times_ns_.assign(count, scan.stamp_ns);
  for (std::size_t i = 0; time_field != nullptr && i < count; ++i) {
    const auto time_ns = read_time_ns(*cloud, *time_field, i);
    if (!time_ns)
      return tl::unexpected("point " + std::to_string(i) + ": '" + time_field->name + "' is not a time");
    const bool absolute = static_cast<double>(*time_ns) > kAbsoluteFromS * 1e9;
    point_times_ns_[i] = absolute ? *time_ns : scan.stamp_ns + *time_ns;
  }
  out.times_ns = point_times_ns_;
  if (count == 0) out.times_ns.push_back(scan.stamp_ns);
  std::sort(out.times_ns.begin(), out.times_ns.end());
  out.times_ns.erase(std::unique(out.times_ns.begin(), out.times_ns.end()), out.times_ns.end());
  out.stamp_ns = out.times_ns.back();
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = std::lower_bound(out.times_ns.begin(), out.times_ns.end(), point_times_ns_[i]);
    out.returns.push_back({cloud->number(*axes[0], i), cloud->number(*axes[1], i), cloud->number(*axes[2], i),
                           static_cast<std::uint32_t>(at - out.times_ns.begin())});
  }
  return {};
}

}  // namespace gvom::ingest
