// Colours, colour maps and the scales that take values to them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gvom::snapshot {

struct Rgb {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
  bool operator==(const Rgb& o) const { return r == o.r && g == o.g && b == o.b; }
  bool operator!=(const Rgb& o) const { return !(*this == o); }
};

/// A column that nobody observed. No colour map below comes near it.
inline constexpr Rgb kUnknown{214, 216, 220};

/// Evenly spaced colours, linear between them.
struct ColourMap {
  const Rgb* stops;
  std::size_t count;

  /// `fraction` is clamped to 0 .. 1.
  [[nodiscard]] Rgb at(double fraction) const;
};

extern const ColourMap kDepths;     ///< Indigo, teal, yellow: general purpose, monotonic in lightness.
extern const ColourMap kHeat;       ///< Pale yellow, orange, dark red: little to much.
extern const ColourMap kFreshness;  ///< Bright to dark violet: new to old.
extern const ColourMap kDiverging;  ///< Blue, white, red: negative, zero, positive.
extern const ColourMap kGreens;     ///< Pale to deep green: soft obstacles.
extern const ColourMap kReds;       ///< Bright red to nearly black: hard obstacles.
extern const ColourMap kViolets;    ///< Violets: holes and ditches.
extern const ColourMap kTraffic;    ///< Green, yellow, red: cost.
extern const ColourMap kLowRoof;    ///< Red to pale blue: little clearance to much.

/// From values to 0 .. 1 of a colour map.
struct Scale {
  double low = 0.0;
  double high = 1.0;
  bool logarithmic = false;  ///< `low` and `high` are then still values, not exponents; both > 0.

  /// Not clamped, except that a logarithmic scale takes values <= 0 as `low`.
  [[nodiscard]] double fraction(double value) const;
};

/// From the 2nd to the 98th percentile of the finite values, widened about its middle to `min_span`: few
/// outliers don't wash out the picture, and noise on flat ground doesn't look like hills.
Scale robust_scale(const float* values, std::size_t count, double min_span);

struct Tick {
  double value;
  std::string label;
};

/// Round values (1, 2, 5 times a power of ten; decades where logarithmic) inside the scale, about
/// `wanted` of them.
std::vector<Tick> ticks(const Scale& scale, int wanted);

/// The largest of 1, 2, 5 times a power of ten that is not above `value` (> 0).
double round_below(double value);

}  // namespace gvom::snapshot
