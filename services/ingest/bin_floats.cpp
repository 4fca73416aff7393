#include "services/ingest/bin_floats.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/ingest/bytes.hpp"

namespace gvom::ingest {
namespace {

constexpr std::size_t kMaxPeriod = 8;
constexpr std::size_t kWindow = 840;  // a multiple of every period
constexpr std::size_t kWindows = 16;
constexpr std::size_t kFewValues = 200;
constexpr double kLeastBits = 0.03;
constexpr double kAsMuch = 0.85;    // of the bits of the best period: a divisor of it that explains as much
constexpr double kFarLess = 0.3;    // what any other period may explain
constexpr double kFarthestM = 1e5;  // no lidar sees as far

// Kinds of values: zero, no number, and by sign, whole or not, and power of two.
constexpr int kSmallestPower = -8, kLargestPower = 14;
constexpr std::size_t kPowers = kLargestPower - kSmallestPower + 1;
constexpr std::size_t kKinds = 2 + 4 * kPowers;

std::uint8_t kind_of(float value) {
  if (value == 0) return 0;
  if (!(std::abs(value) < kFarthestM)) return 1;
  const int power = std::clamp(std::ilogb(value), kSmallestPower, kLargestPower) - kSmallestPower;
  const int group = (value < 0 ? 2 : 0) + (value == std::trunc(value) ? 1 : 0);
  return static_cast<std::uint8_t>(2 + group * static_cast<int>(kPowers) + power);
}

/// The kinds of some values, in windows that begin at multiples of every period.
struct Sample {
  std::array<std::uint8_t, kWindow * kWindows> kinds;
  std::size_t size = 0;
  std::size_t not_zero = 0;

  explicit Sample(Bytes file) {
    const std::size_t values = file.size / sizeof(float);
    const std::size_t windows = std::min((values + kWindow - 1) / kWindow, kWindows);
    const std::size_t all = values / kWindow;
    for (std::size_t w = 0; w < windows; ++w) {
      const std::size_t begin = (all <= kWindows ? w : w * (all - 1) / (kWindows - 1)) * kWindow;
      for (std::size_t i = begin; i < std::min(begin + kWindow, values); ++i) {
        const std::uint8_t kind = kind_of(load_le<float>(file.data + i * sizeof(float)));
        kinds[size++] = kind;
        if (kind != 0) ++not_zero;
      }
    }
  }
};

/// What the place within a period tells of the kind of a value, in bits (mutual information), less what
/// chance alone would.
double bits_of(const Sample& sample, std::size_t period) {
  std::array<std::array<std::uint32_t, kKinds>, kMaxPeriod> counts{};
  for (std::size_t i = 0; i < sample.size; ++i) ++counts[i % period][sample.kinds[i]];
  const auto total = static_cast<double>(sample.size);
  double bits = 0;
  int kinds = 0;
  std::array<double, kMaxPeriod> of_place{};
  for (std::size_t place = 0; place < period; ++place)
    for (const std::uint32_t count : counts[place]) of_place[place] += count;
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    double of_kind = 0;
    for (std::size_t place = 0; place < period; ++place) of_kind += counts[place][kind];
    if (of_kind > 0) ++kinds;
    for (std::size_t place = 0; place < period; ++place) {
      const double both = counts[place][kind];
      if (both > 0) bits += both / total * std::log2(both * total / (of_kind * of_place[place]));
    }
  }
  return bits - (kinds - 1) * static_cast<double>(period - 1) / (2 * total * std::log(2.0));
}

}  // namespace

FloatsJudgement judge_floats(Bytes file) {
  const Sample sample(file);
  FloatsJudgement judgement;
  judgement.empty = sample.not_zero == 0;
  if (sample.not_zero < kFewValues) return judgement;
  std::array<double, kMaxPeriod + 1> bits{};
  for (std::size_t period = 2; period <= kMaxPeriod; ++period) bits[period] = bits_of(sample, period);
  const double best = *std::max_element(bits.begin(), bits.end());
  std::size_t floats = 2;
  while (bits[floats] < kAsMuch * best) ++floats;
  judgement.kind = best < kLeastBits ? FloatsJudgement::Kind::none : FloatsJudgement::Kind::found;
  for (std::size_t other = 2; other <= kMaxPeriod; ++other) {
    const bool related = other % floats == 0 || floats % other == 0 || (other % 2 == 0 && floats % 2 == 0);
    if (!related && bits[other] > kFarLess * best) judgement.kind = FloatsJudgement::Kind::none;
  }
  judgement.floats = floats;
  return judgement;
}

tl::expected<void, std::string> check_floats(Bytes file, std::size_t floats) {
  const FloatsJudgement judgement = judge_floats(file);
  if (judgement.kind == FloatsJudgement::Kind::none)
    return tl::unexpected(std::string("does not look like points: nothing in it comes again"));
  if (judgement.kind == FloatsJudgement::Kind::found && judgement.floats != floats)
    return tl::unexpected("looks like " + std::to_string(judgement.floats) + " floats a point, not " +
                          std::to_string(floats));
  const std::size_t bytes = floats * sizeof(float);
  std::size_t far = 0;
  for (std::size_t at = 0; at + bytes <= file.size; at += bytes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float value = load_le<float>(file.data + at + axis * sizeof(float));
      if (std::abs(value) > kFarthestM) {
        ++far;
        break;
      }
    }
  }
  constexpr std::size_t kOneIn = 20;
  if (far * kOneIn > file.size / bytes)
    return tl::unexpected(std::to_string(far) + " of its " + std::to_string(file.size / bytes) +
                          " points are beyond 100 km: not float32 in metres");
  return {};
}

}  // namespace gvom::ingest
