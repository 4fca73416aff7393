#include "tools/drive/cli/figures.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace gvom::driving {
namespace {

/// Takes a line apart, field by field; the last one may hold commas.
class Fields {
 public:
  explicit Fields(const std::string& line) : rest_(line) {}

  std::string text() {
    const std::size_t comma = rest_.find(',');
    const std::string field(rest_.substr(0, comma));
    is_whole_ = is_whole_ && comma != std::string_view::npos;
    rest_.remove_prefix(comma == std::string_view::npos ? rest_.size() : comma + 1);
    return field;
  }
  template <class Number>
  Number number() {
    const std::string field = text();
    Number value{};
    const auto read = std::from_chars(field.data(), field.data() + field.size(), value);
    is_whole_ = is_whole_ && read.ec == std::errc{} && read.ptr == field.data() + field.size();
    return value;
  }
  std::optional<double> number_or_nothing() {
    if (!rest_.empty() && rest_.front() == ',') return text(), std::nullopt;
    return number<double>();
  }
  [[nodiscard]] std::string rest() const { return std::string(rest_); }
  [[nodiscard]] bool is_whole() const { return is_whole_; }

 private:
  std::string_view rest_;
  bool is_whole_ = true;
};

std::string mishap_of(const std::optional<Mishap>& mishap) {
  if (!mishap) return {};
  const std::string what = words_of(mishap->what);
  return mishap->what == Accident::hit ? what + " " + words_of(mishap->against) : what;
}

void add_attitude(const DriveLog& log, Figures& figures) {
  for (const DriveStep& step : log.steps) {
    const Eigen::Matrix3d R = step.T_odom_base.rotation.toRotationMatrix();
    const double share = 1.0 / static_cast<double>(log.steps.size());
    figures.roll_rad += share * std::abs(std::atan2(R(2, 1), R(2, 2)));
    figures.pitch_rad += share * std::abs(std::asin(std::clamp(-R(2, 0), -1.0, 1.0)));
  }
}

}  // namespace

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return NAN;
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

Figures figures_of(const std::string& world, std::uint64_t seed, const SessionResult& result) {
  const DriveLog& log = result.log;
  Figures figures;
  figures.seed = seed;
  figures.world = world;
  figures.outcome = words_of(result.outcome);
  figures.mishap = mishap_of(log.mishap);
  if (result.way) figures.way_s = result.way->seconds;
  figures.seconds = log.seconds();
  figures.driven_m = log.driven_m;
  figures.top_mps = result.top_speed_mps;
  figures.nearest_m = log.nearest_m;
  figures.false_stops = result.false_stops;
  add_attitude(log, figures);
  if (!result.cycle_ms.empty()) {
    figures.cycle_p50_ms = quantile(result.cycle_ms, 0.5);
    figures.cycle_p99_ms = quantile(result.cycle_ms, 0.99);
  }
  figures.end = result.end;
  return figures;
}

const char* const kFigureNames =
    "seed,world,outcome,mishap,way_s,seconds,driven_m,top_mps,nearest_m,false_stops,roll_rad,pitch_rad,"
    "cycle_p50_ms,cycle_p99_ms,end";

std::string line_of(const Figures& figures) {
  char way[32] = "", numbers[240];
  if (figures.way_s) std::snprintf(way, sizeof way, "%.1f", *figures.way_s);
  std::snprintf(numbers, sizeof numbers, "%s,%.1f,%.1f,%.2f,%.3f,%d,%.4f,%.4f,%.2f,%.2f", way,
                figures.seconds, figures.driven_m, figures.top_mps, figures.nearest_m, figures.false_stops,
                figures.roll_rad, figures.pitch_rad, figures.cycle_p50_ms, figures.cycle_p99_ms);
  return std::to_string(figures.seed) + "," + figures.world + "," + figures.outcome + "," + figures.mishap +
         "," + numbers + "," + figures.end;
}

tl::expected<Figures, std::string> read_figures(const std::string& line) {
  Fields fields(line);
  Figures figures;
  figures.seed = fields.number<std::uint64_t>();
  figures.world = fields.text();
  figures.outcome = fields.text();
  figures.mishap = fields.text();
  figures.way_s = fields.number_or_nothing();
  figures.seconds = fields.number<double>();
  figures.driven_m = fields.number<double>();
  figures.top_mps = fields.number<double>();
  figures.nearest_m = fields.number<double>();
  figures.false_stops = fields.number<int>();
  figures.roll_rad = fields.number<double>();
  figures.pitch_rad = fields.number<double>();
  figures.cycle_p50_ms = fields.number<double>();
  figures.cycle_p99_ms = fields.number<double>();
  figures.end = fields.rest();
  if (!fields.is_whole()) return tl::unexpected("expected " + std::string(kFigureNames) + ", got: " + line);
  return figures;
}

}  // namespace gvom::driving
