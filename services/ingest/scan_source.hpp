// Recordings with one file for each sweep: KITTI's .bin, and .pcd.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "services/ingest/packet.hpp"
#include "services/ingest/pcd.hpp"
#include "services/ingest/scan_files.hpp"

namespace gvom::ingest {

class ScanSource final : public Source {
 public:
  /// See list_scans for `path`.
  static tl::expected<std::unique_ptr<Source>, std::string> open(const std::string& path,
                                                                 const SourceOptions& options);

  tl::expected<SourceEvent, std::string> next(Sweep& out, std::chrono::milliseconds timeout) override;
  tl::expected<void, std::string> rewind() override;
  [[nodiscard]] bool is_live() const override { return false; }
  void set_time_hint(std::int64_t /*stamp_ns*/) override {}
  [[nodiscard]] const SourceCounters& counters() const override { return state_.counters; }
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return state_.warnings; }

 private:
  ScanSource(std::vector<ScanFile> scans, const SourceOptions& options, SourceState state);
  tl::expected<void, std::string> read_file(const std::string& path);
  tl::expected<void, std::string> read_bin(const ScanFile& scan, Sweep& out);
  tl::expected<void, std::string> read_pcd(const ScanFile& scan, Sweep& out);
  std::size_t limit(std::size_t points);

  std::vector<ScanFile> scans_;
  std::size_t max_returns_;
  SourceState state_;
  std::size_t index_ = 0;
  std::vector<std::uint8_t> file_;
  std::vector<std::uint8_t> unpacked_;
  std::vector<std::int64_t> point_times_ns_;
};

}  // namespace gvom::ingest
