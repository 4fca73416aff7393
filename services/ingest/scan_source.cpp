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

#include "services/ingest/arrival_clock.hpp"
#include "services/ingest/bytes.hpp"
#include "services/ingest/cloud_points.hpp"

namespace gvom::ingest {
namespace {

constexpr std::size_t kFilesToJudge = 20;
constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 30;

const std::string kSayFloats = ": say scans:PATH?floats=4 (x y z intensity), 5 (nuScenes) or 6 (Waymo)";

const std::string kTimeOption = "scans:PATH?time=";

bool is_bin(const ScanFile& scan) {
  return scan.path.compare(scan.path.size() - 4, 4, ".bin") == 0;
}

}  // namespace

tl::expected<std::unique_ptr<Source>, std::string> ScanSource::open(const std::string& path,
                                                                    const SourceOptions& options,
                                                                    const Format& format) {
  SourceState state;
  auto scans = list_scans(path, state.warnings);
  if (!scans) return tl::unexpected(scans.error());
  std::unique_ptr<ScanSource> source(new ScanSource(std::move(*scans), options, std::move(state), format));
  if (!format.floats && is_bin(source->scans_[0])) {
    const auto found = source->find_floats();
    if (!found) return tl::unexpected(found.error());
  }
  return source;
}

ScanSource::ScanSource(std::vector<ScanFile> scans, const SourceOptions& options, SourceState state,
                       const Format& format)
    : scans_(std::move(scans)),
      max_returns_(options.max_returns),
      clock_offset_ns_(options.clock_offset_ns),
      state_(std::move(state)),
      floats_(format.floats.value_or(kMinFloats)),
      floats_asked_(format.floats.has_value()),
      times_(format.time) {
  std::uintmax_t largest = 0;
  for (const ScanFile& scan : scans_) {
    std::error_code error;
    const auto size = std::filesystem::file_size(scan.path, error);
    if (!error) largest = std::max(largest, size);
  }
  file_.reserve(std::min(largest, kMaxFileBytes));
}

/// By the values of the first files that tell it, else by the sizes of all.
tl::expected<void, std::string> ScanSource::find_floats() {
  bool empty = true;
  for (std::size_t i = 0; i < std::min(scans_.size(), kFilesToJudge); ++i) {
    const auto read = read_file(scans_[i].path);
    if (!read) return tl::unexpected(scans_[i].path + ": " + read.error());
    const FloatsJudgement judgement = judge_floats({file_.data(), file_.size()});
    empty = empty && judgement.empty;
    if (judgement.kind == FloatsJudgement::Kind::unknown) continue;
    if (judgement.kind == FloatsJudgement::Kind::three_or_six)
      return tl::unexpected(scans_[i].path + ": looks like 3 or 6 floats a point" + kSayFloats);
    const bool found = judgement.kind == FloatsJudgement::Kind::found;
    if (!found || judgement.floats < kMinFloats || judgement.floats > kMaxFloats) {
      return tl::unexpected(scans_[i].path + ": " +
                            (found ? "looks like " + std::to_string(judgement.floats) + " floats a point"
                                   : "does not look like points of floats") +
                            "; if it is otherwise" + kSayFloats);
    }
    floats_ = judgement.floats;
    if (floats_ != kMinFloats) {
      state_.warnings.push_back(
          scans_[i].path + ": taken as " + std::to_string(floats_) +
          " floats a point, as its values say (scans:PATH?floats=" + std::to_string(floats_) + ")");
    }
    return {};
  }
  std::vector<std::size_t> fitting;  // as good a reading as any if there is nothing but zeros
  for (std::size_t floats = kMinFloats; floats <= kMaxFloats; ++floats) {
    const bool fits = std::all_of(scans_.begin(), scans_.end(), [floats](const ScanFile& scan) {
      std::error_code error;
      return std::filesystem::file_size(scan.path, error) % (floats * sizeof(float)) == 0;
    });
    if (fits) fitting.push_back(floats);
  }
  if (fitting.size() > 1 && !empty)
    return tl::unexpected(scans_[0].path + ": too few points to tell how many floats each has" + kSayFloats);
  if (!fitting.empty()) floats_ = fitting[0];
  return {};
}

tl::expected<SourceEvent, std::string> ScanSource::next(Sweep& out, std::chrono::milliseconds) {
  out.clear();
  out.returns.reserve(max_returns_);
  if (index_ == scans_.size()) return SourceEvent::kEnd;
  const ScanFile& scan = scans_[index_++];
  auto done = read_file(scan.path);
  if (done) done = is_bin(scan) ? read_bin(scan, out) : read_pcd(scan, out);
  if (!done) {
    out.clear();
    index_ = scans_.size();
    return tl::unexpected(scan.path + ": " + done.error());
  }
  shift(out, clock_offset_ns_);
  ++state_.counters.sweeps;
  return SourceEvent::kSweep;
}

tl::expected<void, std::string> ScanSource::rewind() {
  index_ = 0;
  newest_ns_.reset();
  return {};
}

/// Plain system calls: a stream would allocate its buffer for each file.
tl::expected<void, std::string> ScanSource::read_file(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return tl::unexpected(std::string(std::strerror(errno)));
  struct stat status {};
  ::fstat(file, &status);
  const auto bytes = static_cast<std::uintmax_t>(status.st_size);
  if (bytes > kMaxFileBytes) {
    ::close(file);
    return tl::unexpected("its " + std::to_string(bytes) +
                          " bytes are no sweep's: a gigabyte is read at most");
  }
  file_.resize(bytes);
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
std::size_t ScanSource::limit(const ScanFile& scan, std::size_t points) {
  const std::size_t taken = std::min(points, max_returns_);
  if (taken < points && state_.counters.overflow_returns == 0) {
    state_.warnings.push_back(scan.path + ": " + std::to_string(points) +
                              " points, of which max_returns takes " + std::to_string(taken));
  }
  state_.counters.overflow_returns += points - taken;
  return taken;
}

/// What the file says against the number of floats that was found, or asked for.
tl::expected<void, std::string> ScanSource::judge_file(const ScanFile& scan) {
  const auto checked = check_floats({file_.data(), file_.size()}, floats_);
  if (checked) return {};
  if (!floats_asked_) return tl::unexpected(checked.error() + kSayFloats);
  if (!told_floats_) state_.warnings.push_back(scan.path + ": read as it was asked, but " + checked.error());
  told_floats_ = true;
  return {};
}

void ScanSource::tell_no_hits(const ScanFile& scan, const Hits& hits) {
  if (hits.count() > 0 || told_no_hits_) return;
  told_no_hits_ = true;
  state_.warnings.push_back(scan.path + ": no hit in the whole scan: empty, or all zero or not a number");
}

tl::expected<void, std::string> ScanSource::read_bin(const ScanFile& scan, Sweep& out) {
  const std::size_t bytes = floats_ * sizeof(float);
  if (file_.size() % bytes != 0) {
    return tl::unexpected("its size of " + std::to_string(file_.size()) + " bytes is not a multiple of " +
                          std::to_string(bytes));
  }
  if (auto judged = judge_file(scan); !judged) return judged;
  // Far hits are refused also where the number of floats was asked for: it says nothing of units.
  const Hits hits = count_hits({file_.data(), file_.size()}, floats_);
  if (auto judged = hits.judge(); !judged) return judged;
  tell_no_hits(scan, hits);
  out.times_ns.push_back(scan.stamp_ns);
  out.stamp_ns = scan.stamp_ns;
  const std::size_t count = limit(scan, file_.size() / bytes);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* point = file_.data() + i * bytes;
    out.returns.push_back({load_le<float>(point), load_le<float>(point + 4), load_le<float>(point + 8), 0});
  }
  return {};
}

/// Fills the places and whether they are hits; the times are not known yet.
tl::expected<void, std::string> ScanSource::read_places(const ScanFile& scan, const PcdCloud& cloud,
                                                        Sweep& out) {
  if (cloud.more_points > 0 && !told_more_points_) {
    state_.warnings.push_back(scan.path + ": holds " + std::to_string(cloud.more_points) +
                              " points more than its header says, which are left out");
    told_more_points_ = true;
  }
  return take_points(cloud, limit(scan, cloud.points), out, is_hit_).map([&](const Hits& hits) {
    tell_no_hits(scan, hits);
  });
}

tl::expected<void, std::string> ScanSource::read_pcd(const ScanFile& scan, Sweep& out) {
  const auto cloud = parse_pcd({file_.data(), file_.size()}, unpacked_);
  if (!cloud) return tl::unexpected(cloud.error());
  auto done = read_places(scan, *cloud, out);
  if (done)
    done = times_.read({*cloud, is_hit_, scan.stamp_ns, scan.path, kTimeOption}, point_times_ns_,
                       state_.warnings);
  if (!done) return done;
  set_times(point_times_ns_, scan.stamp_ns, out);
  const bool has_hits = std::find(is_hit_.begin(), is_hit_.end(), true) != is_hit_.end();
  if (has_hits && newest_ns_ && out.stamp_ns <= *newest_ns_)
    return tl::unexpected(std::string("time goes back: it is before the scan in front of it"));
  if (has_hits) newest_ns_ = out.stamp_ns;
  return {};
}

}  // namespace gvom::ingest
