// Recordings with one file for each sweep: KITTI's .bin, and .pcd.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/ingest/bin_floats.hpp"
#include "services/ingest/packet.hpp"
#include "services/ingest/pcd.hpp"
#include "services/ingest/point_times.hpp"
#include "services/ingest/scan_files.hpp"

namespace gvom::ingest {

class ScanSource final : public Source {
 public:
  /// What the URI says of the files, instead of finding it out.
  struct Format {
    std::optional<std::size_t> floats;  ///< A point of a .bin has, kMinFloats .. kMaxFloats.
    std::optional<TimeUnit> time;       ///< Of the time field of a .pcd.
  };

  /// See list_scans for `path`. An error too if it cannot be told how many floats a point of a .bin has.
  static tl::expected<std::unique_ptr<Source>, std::string> open(const std::string& path,
                                                                 const SourceOptions& options,
                                                                 const Format& format);

  tl::expected<SourceEvent, std::string> next(Sweep& out, std::chrono::milliseconds timeout) override;
  tl::expected<void, std::string> rewind() override;
  [[nodiscard]] bool is_live() const override { return false; }
  void set_time_hint(std::int64_t /*stamp_ns*/) override {}
  [[nodiscard]] const SourceCounters& counters() const override { return state_.counters; }
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return state_.warnings; }

 private:
  ScanSource(std::vector<ScanFile> scans, const SourceOptions& options, SourceState state,
             const Format& format);
  tl::expected<void, std::string> find_floats();
  tl::expected<void, std::string> judge_file(const ScanFile& scan);
  void tell_no_hits(const ScanFile& scan, const Hits& hits);
  tl::expected<void, std::string> read_file(const std::string& path);
  tl::expected<void, std::string> read_bin(const ScanFile& scan, Sweep& out);
  tl::expected<void, std::string> read_pcd(const ScanFile& scan, Sweep& out);
  tl::expected<void, std::string> read_places(const ScanFile& scan, const PcdCloud& cloud, Sweep& out);
  std::size_t limit(const ScanFile& scan, std::size_t points);

  std::vector<ScanFile> scans_;
  std::size_t max_returns_;
  std::int64_t clock_offset_ns_;
  SourceState state_;
  std::size_t index_ = 0;
  std::vector<std::uint8_t> file_;
  std::vector<std::uint8_t> unpacked_;
  std::size_t floats_ = kMinFloats;  // a point of a .bin
  bool floats_asked_;
  bool told_floats_ = false;
  bool told_no_hits_ = false;
  bool told_more_points_ = false;
  std::optional<std::int64_t> newest_ns_;  // stamp of the scans of a .pcd so far
  PointTimes times_;
  std::vector<bool> is_hit_;
  std::vector<std::int64_t> point_times_ns_;
};

}  // namespace gvom::ingest
