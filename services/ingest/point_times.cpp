#include "services/ingest/point_times.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

namespace gvom::ingest {
namespace {

constexpr double kLongestSweepS = 2.0;
constexpr double kMostPointsPerS = 1e7;
constexpr std::size_t kFewPoints = 1000;  // a piece of a sweep may be of any length
constexpr double kLatestS = 4e9;          // the year 2096
constexpr double kSince1970S = 1e9;       // from here on a time counts from 1970 (2001 and later)
constexpr TimeUnit kUnits[] = {TimeUnit::ns, TimeUnit::us, TimeUnit::ms, TimeUnit::s};

std::string name_of(TimeUnit unit) {
  switch (unit) {
    case TimeUnit::ns:
      return "ns";
    case TimeUnit::us:
      return "us";
    case TimeUnit::ms:
      return "ms";
    case TimeUnit::s:
      return "s";
    case TimeUnit::none:
      break;
  }
  return "none";
}

double seconds_of(TimeUnit unit) {
  return 1e-9 * static_cast<double>(unit);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

bool looks_like_time(const std::string& field) {
  const std::string name = lower(field);
  if (name.find("time") != std::string::npos || name.find("stamp") != std::string::npos) return true;
  if (name.compare(0, 2, "t_") == 0) return true;
  for (const char* end : {"_t", "_ns", "_us", "_ms", "sec", "secs", "second", "seconds"})
    if (ends_with(name, end)) return true;
  return name == "t" || name == "ts" || name == "dt";
}

TimeUnit usual_unit(const PcdField& field) {
  return field.type == 'F' ? TimeUnit::s : TimeUnit::ns;
}

/// Whole units apart: their product with 1e9 is beyond a double.
std::int64_t to_ns(double time, TimeUnit unit) {
  const double whole = std::trunc(time);
  return static_cast<std::int64_t>(whole) * static_cast<std::int64_t>(unit) +
         std::llround((time - whole) * static_cast<double>(unit));
}

bool is_usable(const PcdField& field) {
  return field.count == 1 && field.size >= 2;
}

}  // namespace

/// What the hits of one scan say, in the field's own unit.
struct PointTimes::Evidence {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  std::size_t points = 0;
  std::size_t first = 0;  // of them

  void add(double time, std::size_t point) {
    least = std::min(least, time);
    most = std::max(most, time);
    if (points++ == 0) first = point;
  }
  [[nodiscard]] std::string text() const {
    return std::to_string(points) + " points from " + std::to_string(least) + " to " + std::to_string(most);
  }
  [[nodiscard]] double span() const { return most - least; }
  [[nodiscard]] double largest() const { return std::max(std::abs(least), std::abs(most)); }
  [[nodiscard]] bool fits(TimeUnit unit) const {
    return span() * seconds_of(unit) <= kLongestSweepS && !(of_clock(unit) && is_too_fast(unit)) &&
           largest() * seconds_of(unit) <= kLatestS;
  }
  /// More points in a second than any lidar measures: not the times of a whole sweep.
  [[nodiscard]] bool is_too_fast(TimeUnit unit) const {
    return points >= kFewPoints && span() > 0 &&
           static_cast<double>(points) > span() * seconds_of(unit) * kMostPointsPerS;
  }
  [[nodiscard]] bool since_1970(TimeUnit unit) const { return least * seconds_of(unit) >= kSince1970S; }
  [[nodiscard]] bool of_clock(TimeUnit unit) const { return largest() * seconds_of(unit) > kLongestSweepS; }
};

std::optional<TimeUnit> parse_time_unit(const std::string& word) {
  for (const TimeUnit unit : {TimeUnit::none, TimeUnit::ns, TimeUnit::us, TimeUnit::ms, TimeUnit::s})
    if (word == name_of(unit)) return unit;
  return std::nullopt;
}

const PcdField* PointTimes::find_time(const PcdCloud& cloud) {
  for (const char* name : {"t", "time", "timestamp", "time_stamp", "time_offset", "offset_time"}) {
    for (const PcdField& field : cloud.fields)
      if (is_usable(field) && lower(field.name) == name) return &field;
  }
  return nullptr;
}

const PcdField* PointTimes::find_field(const TimedScan& scan, std::vector<std::string>& warnings) {
  const PcdField* const found = unit_ == TimeUnit::none ? nullptr : find_time(scan.cloud);
  for (const PcdField& field : scan.cloud.fields) {
    if (&field == found || field.count == 0 || asked_ || !looks_like_time(field.name)) continue;
    if (!told_.insert(field.name).second) continue;
    warnings.push_back(scan.path + ": field '" + field.name + "' looks like a time and is not used: " +
                       (found != nullptr ? "the times are those of '" + found->name + "'"
                                         : "all points take the stamp of the scan, without deskewing"));
  }
  return found;
}

tl::expected<void, std::string> PointTimes::decide(const PcdField& field, const Evidence& evidence,
                                                   const TimedScan& scan,
                                                   std::vector<std::string>& warnings) {
  const TimeUnit usual = usual_unit(field);
  std::vector<TimeUnit> fitting;
  for (const TimeUnit unit : kUnits)
    if (evidence.fits(unit)) fitting.push_back(unit);
  const bool fits_as_usual = evidence.fits(usual);
  const bool doubtful =
      fits_as_usual && evidence.of_clock(usual) && !evidence.since_1970(usual) &&
      std::any_of(fitting.begin(), fitting.end(), [&](TimeUnit unit) { return evidence.since_1970(unit); });
  if (doubtful || (!fits_as_usual && fitting.size() != 1)) {
    return tl::unexpected("the unit of field '" + field.name + "' cannot be told: " + evidence.text() + "; " +
                          scan.option + "ns (us, ms, s, or none: without deskewing) says it");
  }
  const TimeUnit unit = fits_as_usual ? usual : fitting[0];
  if (evidence.span() > 0 || evidence.of_clock(unit)) unit_ = unit;
  const std::string seconds = std::to_string(evidence.span() * seconds_of(unit)) + " s";
  if (unit != usual && unit_) {
    warnings.push_back(scan.path + ": field '" + field.name + "' is taken as " + name_of(unit) + ": its " +
                       std::to_string(evidence.points) + " points take " + seconds +
                       ", and no other unit fits");
  }
  is_too_fast_ = evidence.is_too_fast(unit);
  if (is_too_fast_) {
    warnings.push_back(scan.path + ": the " + std::to_string(evidence.points) + " points take only " +
                       seconds + " by '" + field.name + "' in " + name_of(unit) +
                       ": they are hardly deskewed; times within a packet? Another unit: " + scan.option +
                       "us");
  }
  return {};
}

/// Unit and origin: found out, or those of the scans before, which this one must keep to.
tl::expected<void, std::string> PointTimes::settle(const PcdField& field, const Evidence& evidence,
                                                   const TimedScan& scan,
                                                   std::vector<std::string>& warnings) {
  const TimeUnit likely = unit_.value_or(usual_unit(field));
  const bool coarse = field.type == 'F' && field.size == 4 && evidence.of_clock(likely) &&
                      evidence.span() < 1000 * evidence.largest() * std::numeric_limits<float>::epsilon();
  if (coarse) {
    return tl::unexpected("field '" + field.name + "' is a clock's time in 4 bytes, which are too few; " +
                          scan.option + "none does without");
  }
  if (!unit_) {
    const auto decided = decide(field, evidence, scan, warnings);
    if (!decided) return decided;
  } else if (!asked_ && !is_too_fast_ && evidence.is_too_fast(*unit_)) {
    return tl::unexpected("'" + field.name + "' is not a time in " + name_of(*unit_) +
                          " as before: " + evidence.text());
  }
  const TimeUnit unit = unit_.value_or(usual_unit(field));
  if (!(evidence.largest() * seconds_of(unit) <= kLatestS) || (!asked_ && !evidence.fits(unit))) {
    return tl::unexpected("'" + field.name + "' is not a time in " + name_of(unit) + ": " + evidence.text());
  }
  const bool clock = evidence.of_clock(unit);
  if (of_clock_.value_or(clock) != clock) {
    return tl::unexpected("the times in '" + field.name +
                          "' count from another zero than in the scans before");
  }
  if (!of_clock_ && clock) {
    warnings.push_back(scan.path + ": the times in '" + field.name +
                       "' are a clock's, and taken instead of the stamps of the scans");
  }
  if (unit_) of_clock_ = clock;
  return {};
}

/// What is a float of seconds now would pass as integers of nanoseconds: a sweep of no time at all.
void PointTimes::forget_other_field(const PcdField& field, const TimedScan& scan,
                                    std::vector<std::string>& warnings) {
  const std::string text = field.name + " " + field.type + std::to_string(8 * field.size);
  const std::string before = std::exchange(field_, text);
  if (asked_ || before.empty() || before == text) return;
  unit_.reset();
  of_clock_.reset();
  warnings.push_back(scan.path + ": the times are in the field '" + text + "', before in '" + before +
                     "': unit and origin are found out anew");
}

tl::expected<void, std::string> PointTimes::settle_or_begin_anew(const PcdField& field,
                                                                 const Evidence& evidence,
                                                                 const TimedScan& scan,
                                                                 std::vector<std::string>& warnings) {
  const bool bound = !asked_ && unit_;
  const auto settled = settle(field, evidence, scan, warnings);
  refused_ = settled || !bound ? 0 : refused_ + 1;
  if (refused_ < kAnew) return settled;
  refused_ = 0;
  const auto unit_before = std::exchange(unit_, std::nullopt);
  const auto origin_before = std::exchange(of_clock_, std::nullopt);
  const std::size_t told = warnings.size();
  if (const auto anew = settle(field, evidence, scan, warnings);
      !anew || std::exchange(is_too_fast_, false)) {
    unit_ = unit_before;
    of_clock_ = origin_before;
    warnings.resize(told);
    return settled;
  }
  warnings.push_back(scan.path + ": the times in '" + field.name + "' are others than those before, for " +
                     std::to_string(kAnew) + " scans: unit and origin are found out anew (" +
                     name_of(unit_.value_or(usual_unit(field))) + ")");
  return {};
}

tl::expected<void, std::string> PointTimes::read(const TimedScan& scan, std::vector<std::int64_t>& out_ns,
                                                 std::vector<std::string>& warnings) {
  const std::size_t count = scan.is_hit.size();
  out_ns.assign(count, scan.stamp_ns);
  const PcdField* field = find_field(scan, warnings);
  if (field == nullptr) return {};
  forget_other_field(*field, scan, warnings);
  Evidence evidence;
  for (std::size_t i = 0; i < count; ++i) {
    if (!scan.is_hit[i]) continue;
    const double time = scan.cloud.number(*field, i);
    if (!std::isfinite(time))
      return tl::unexpected("point " + std::to_string(i) + ": '" + field->name + "' is not a time");
    evidence.add(time, i);
  }
  if (evidence.points == 0) return {};
  const auto settled = settle_or_begin_anew(*field, evidence, scan, warnings);
  if (!settled) return settled;
  const TimeUnit unit = unit_.value_or(usual_unit(*field));
  const std::int64_t zero_ns = evidence.of_clock(unit) ? 0 : scan.stamp_ns;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = scan.is_hit[i] ? i : evidence.first;
    out_ns[i] =
        zero_ns + (field->type == 'F' ? to_ns(scan.cloud.number(*field, from), unit)
                                      : scan.cloud.integer(*field, from) * static_cast<std::int64_t>(unit));
  }
  return {};
}

}  // namespace gvom::ingest
