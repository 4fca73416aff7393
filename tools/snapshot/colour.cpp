#include "tools/snapshot/colour.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace gvom::snapshot {
namespace {

constexpr Rgb kDepthsStops[] = {{52, 16, 92},   {60, 62, 140},  {44, 106, 148}, {30, 146, 138},
                                {72, 184, 108}, {160, 212, 58}, {252, 230, 60}};
constexpr Rgb kHeatStops[] = {{255, 249, 214}, {254, 217, 118}, {253, 160, 60},
                              {230, 80, 40},   {150, 10, 40},   {74, 0, 30}};
constexpr Rgb kFreshnessStops[] = {
    {250, 234, 92}, {250, 162, 58}, {226, 92, 98}, {160, 40, 130}, {52, 16, 110}};
constexpr Rgb kDivergingStops[] = {{28, 70, 150},   {90, 160, 220}, {170, 226, 250}, {255, 252, 224},
                                   {250, 190, 130}, {220, 100, 70}, {150, 20, 40}};
constexpr Rgb kGreensStops[] = {{176, 226, 150}, {88, 180, 88}, {14, 110, 54}};
constexpr Rgb kRedsStops[] = {{236, 60, 40}, {150, 12, 24}, {26, 0, 4}};
constexpr Rgb kVioletsStops[] = {{214, 170, 236}, {156, 82, 206}, {78, 12, 140}};
constexpr Rgb kTrafficStops[] = {
    {200, 234, 206}, {128, 200, 120}, {240, 220, 80}, {242, 150, 50}, {212, 56, 36}};
constexpr Rgb kLowRoofStops[] = {
    {196, 20, 36}, {240, 124, 60}, {250, 210, 100}, {150, 200, 190}, {60, 130, 180}};

template <std::size_t N>
constexpr ColourMap map_of(const Rgb (&stops)[N]) {
  return {stops, N};
}

std::uint8_t mix(std::uint8_t a, std::uint8_t b, double t) {
  return static_cast<std::uint8_t>(std::lround(a + (b - a) * t));
}

std::string superscript(int exponent) {
  static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(exponent))) text += kDigits[digit - '0'];
  return text;
}

std::string number(double value, int decimals) {
  if (value == 0.0) value = 0.0;  // no "-0"
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

}  // namespace

const ColourMap kDepths = map_of(kDepthsStops);
const ColourMap kHeat = map_of(kHeatStops);
const ColourMap kFreshness = map_of(kFreshnessStops);
const ColourMap kDiverging = map_of(kDivergingStops);
const ColourMap kGreens = map_of(kGreensStops);
const ColourMap kReds = map_of(kRedsStops);
const ColourMap kViolets = map_of(kVioletsStops);
const ColourMap kTraffic = map_of(kTrafficStops);
const ColourMap kLowRoof = map_of(kLowRoofStops);

Rgb ColourMap::at(double fraction) const {
  const double position = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(count - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(position), count - 2);
  const double t = position - static_cast<double>(i);
  const Rgb& a = stops[i];
  const Rgb& b = stops[i + 1];
  return {mix(a.r, b.r, t), mix(a.g, b.g, t), mix(a.b, b.b, t)};
}

double Scale::fraction(double value) const {
  if (!logarithmic) return (value - low) / (high - low);
  return value <= 0.0 ? 0.0 : std::log(value / low) / std::log(high / low);
}

Scale robust_scale(const float* values, std::size_t count, double min_span) {
  std::vector<float> finite;
  finite.reserve(count);
  std::copy_if(values, values + count, std::back_inserter(finite), [](float v) { return std::isfinite(v); });
  if (finite.empty()) return {-min_span / 2, min_span / 2};
  const auto percentile = [&finite](double p) {
    const auto at = finite.begin() + std::lround(p * static_cast<double>(finite.size() - 1));
    std::nth_element(finite.begin(), at, finite.end());
    return static_cast<double>(*at);
  };
  const double low = percentile(0.02);
  const double high = percentile(0.98);
  const double widen = std::max(0.0, min_span - (high - low)) / 2;
  return {low - widen, high + widen};
}

double round_below(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {5.0, 2.0})
    if (step * power <= value) return step * power;
  return power;
}

std::vector<Tick> ticks(const Scale& scale, int wanted) {
  std::vector<Tick> out;
  if (scale.logarithmic) {
    const int last = static_cast<int>(std::floor(std::log10(scale.high) + 1e-9));
    for (int e = static_cast<int>(std::ceil(std::log10(scale.low) - 1e-9)); e <= last; ++e)
      out.push_back({std::pow(10.0, e), e == 0 ? "1" : "10" + superscript(e)});
    return out;
  }
  const double span = scale.high - scale.low;
  double step = round_below(span / wanted);
  while (span / step > 1.5 * wanted) step = round_below(step * 2.5);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  for (double i = std::ceil(scale.low / step - 1e-9); i * step <= scale.high + 1e-9 * span; ++i)
    out.push_back({i * step, number(i * step, decimals)});
  return out;
}

}  // namespace gvom::snapshot
