// The times of a scan's points, from whatever field and in whatever unit they are.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/ingest/pcd.hpp"

namespace gvom::ingest {

/// What one unit of a time field is, in nanoseconds; `none`: the field is not used.
enum class TimeUnit : std::int64_t { none = 0, ns = 1, us = 1'000, ms = 1'000'000, s = 1'000'000'000 };

/// "ns", "us", "ms", "s", "none"; nothing for any other word.
std::optional<TimeUnit> parse_time_unit(const std::string& word);

/// What to read: the cloud, which of its points are hits, and the scan's own stamp.
struct TimedScan {
  const PcdCloud& cloud;
  const std::vector<bool>& is_hit;  ///< As many as points are wanted.
  std::int64_t stamp_ns;
  const std::string& path;
  const std::string& option;  ///< How a person says the unit: "scans:PATH?time=".
};

/// Finds out unit and origin from the first scan that tells them, and holds every later one to them, until
/// kAnew in a row don't keep to them, or the field is another: then they are found out anew, with a warning.
/// Whole
/// numbers are nanoseconds, floating-point ones seconds, unless a sweep would then last over 2 s or, by a
/// clock, have more points in a second than any lidar measures, and one other unit fits: that is taken, with
/// a warning. Where it remains open, the scan is refused. Times up to 2 s count from the scan's stamp, others
/// are a clock's.
class PointTimes {
 public:
  static constexpr int kAnew = 20;  ///< A driver that was changed, not a scan that is damaged.

  /// `asked`: instead of finding out.
  explicit PointTimes(std::optional<TimeUnit> asked) : unit_(asked), asked_(asked.has_value()) {}

  /// The field that the times are taken from; null if there is none.
  static const PcdField* find_time(const PcdCloud& cloud);

  /// Fills `out_ns` with one time a point. Fields that look like times and are not used are told of by name,
  /// once. Points that are no hits get a time that a hit has, since theirs may be anything.
  /// Errors name the point or the field.
  tl::expected<void, std::string> read(const TimedScan& scan, std::vector<std::int64_t>& out_ns,
                                       std::vector<std::string>& warnings);

 private:
  struct Evidence;
  const PcdField* find_field(const TimedScan& scan, std::vector<std::string>& warnings);
  tl::expected<void, std::string> decide(const PcdField& field, const Evidence& evidence,
                                         const TimedScan& scan, std::vector<std::string>& warnings);

  tl::expected<void, std::string> settle(const PcdField& field, const Evidence& evidence,
                                         const TimedScan& scan, std::vector<std::string>& warnings);
  void forget_other_field(const PcdField& field, const TimedScan& scan, std::vector<std::string>& warnings);
  tl::expected<void, std::string> settle_or_begin_anew(const PcdField& field, const Evidence& evidence,
                                                       const TimedScan& scan,
                                                       std::vector<std::string>& warnings);

  std::optional<TimeUnit> unit_;
  bool asked_;
  std::optional<bool> of_clock_;
  bool is_too_fast_ = false;    // more points in a second than any lidar measures: told, and used
  std::string field_;           // that unit_ is of: its name and type
  int refused_ = 0;             // in a row, since they don't keep to unit_ and of_clock_
  std::set<std::string> told_;  // fields
};

}  // namespace gvom::ingest
