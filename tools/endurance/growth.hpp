// Whether something grows, told from samples of it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace gvom::endurance {

struct Point {
  double at_s;
  double value;
};

/// Samples over any time in bounded memory: when it is full, every other one is let go.
class Series {
 public:
  void add(double at_s, double value);
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }

 private:
  static constexpr std::size_t kMost = 1024;
  std::vector<Point> points_;
  std::size_t stride_ = 1;
  std::size_t since_kept_ = 0;
};

/// 0 if there are none.
double median(std::vector<double> values);

enum class Measure {
  median,
  least,  ///< Of what comes and goes with the load: what is lost is missing from the lowest, too.
};

struct Growth {
  double first;  ///< The measure of the first quarter of the samples.
  double last;   ///< ... of the last.
  double most;   ///< Of all.
  double hours;  ///< Between the middles of the two.
  [[nodiscard]] double change() const { return last - first; }
  [[nodiscard]] double per_hour() const { return hours > 0 ? change() / hours : 0; }
};

/// Of the samples from `from_s` on; nothing if they are fewer than kLeastSamples.
std::optional<Growth> growth_of(const Series& series, double from_s, Measure measure = Measure::median);

inline constexpr std::size_t kLeastSamples = 40;

}  // namespace gvom::endurance
