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
// What a period explains of the bits of its double, by magnitudes alone. Seen: 0.71 to 1 for pairs of points
// of four floats, 0.48 to 0.61 for points of eight (but 0.77 where the last are velocities); 0.55 to 1 for
// pairs of three, 0.14 to 0.47 for six.
constexpr double kOfPairs = 0.65;
constexpr double kOfThree = 0.5;
constexpr double kSameSide = 0.9;

// Kinds of values: zero, no number, and by sign, whole or not, and power of two.
constexpr int kSmallestPower = -8, kLargestPower = 14;
constexpr std::size_t kPowers = kLargestPower - kSmallestPower + 1;
constexpr std::size_t kKinds = 2 + 4 * kPowers;
constexpr std::uint8_t kZero = 0, kNoNumber = 1, kLeftOut = 255;

std::uint8_t kind_of(float value) {
  if (value == 0) return kZero;
  if (!(std::abs(value) < kFarthestM)) return kNoNumber;
  const int power = std::clamp(std::ilogb(value), kSmallestPower, kLargestPower) - kSmallestPower;
  const int group = (value < 0 ? 2 : 0) + (value == std::trunc(value) ? 1 : 0);
  return static_cast<std::uint8_t>(2 + group * static_cast<int>(kPowers) + power);
}

/// A kind without its sign; zero and no number have no magnitude.
std::uint8_t magnitude_of(std::uint8_t kind) {
  return kind < 2 ? kLeftOut : static_cast<std::uint8_t>((kind - 2) % (2 * kPowers));
}

int sign_of(std::uint8_t kind) {
  if (kind < 2) return 0;
  return kind < 2 + 2 * kPowers ? 1 : -1;
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
        if (kind != kZero) ++not_zero;
      }
    }
  }

  Sample magnitudes() const {
    Sample out = *this;
    std::transform(kinds.begin(), kinds.begin() + static_cast<std::ptrdiff_t>(size), out.kinds.begin(),
                   magnitude_of);
    return out;
  }
};

/// What the place within a period tells of the kind of a value, in bits (mutual information), less what
/// chance alone would.
double bits_of(const Sample& sample, std::size_t period) {
  std::array<std::array<std::uint32_t, kKinds>, kMaxPeriod> counts{};
  double total = 0;
  for (std::size_t i = 0; i < sample.size; ++i) {
    if (sample.kinds[i] == kLeftOut) continue;
    ++counts[i % period][sample.kinds[i]];
    ++total;
  }
  if (total == 0) return 0;
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

/// Whether the two points of a pair are seen in the same direction, as two beams fired at once or two returns
/// of one are: by the signs of x and y, where both are hits. The second half of a longer point is not.
bool are_pairs(const Sample& sample, std::size_t floats) {
  std::size_t both = 0, same = 0;
  for (std::size_t i = 0; i + 2 * floats <= sample.size; i += 2 * floats) {
    const std::uint8_t* first = sample.kinds.data() + i;
    const std::uint8_t* second = first + floats;
    const auto is_hit = [](const std::uint8_t* point) {
      return std::count(point, point + 3, kNoNumber) == 0 && std::count(point, point + 3, kZero) < 3;
    };
    if (!is_hit(first) || !is_hit(second)) continue;
    ++both;
    if (sign_of(first[0]) == sign_of(second[0]) && sign_of(first[1]) == sign_of(second[1])) ++same;
  }
  return static_cast<double>(same) >= kSameSide * static_cast<double>(both);
}

/// Points that come in pairs (beams above and below fired in turn, two returns, every other beam without a
/// hit) make twice their floats the better period.
void look_for_pairs(const Sample& sample, FloatsJudgement& judgement) {
  if (judgement.kind != FloatsJudgement::Kind::found || (judgement.floats != 6 && judgement.floats != 8))
    return;
  const std::size_t half = judgement.floats / 2;
  const Sample magnitudes = sample.magnitudes();
  const double explained = bits_of(magnitudes, half) / bits_of(magnitudes, judgement.floats);
  if (explained < (half == 3 ? kOfThree : kOfPairs) || !are_pairs(sample, half)) return;
  if (half == 3) {
    judgement.kind = FloatsJudgement::Kind::three_or_six;
  } else {
    judgement.floats = half;
  }
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
  while (floats < kMaxPeriod && bits[floats] < kAsMuch * best) ++floats;  // noise may be below 0
  judgement.kind = best < kLeastBits ? FloatsJudgement::Kind::none : FloatsJudgement::Kind::found;
  for (std::size_t other = 2; other <= kMaxPeriod; ++other) {
    const bool related = other % floats == 0 || floats % other == 0 || (other % 2 == 0 && floats % 2 == 0);
    if (!related && bits[other] > kFarLess * best) judgement.kind = FloatsJudgement::Kind::none;
  }
  judgement.floats = floats;
  look_for_pairs(sample, judgement);
  return judgement;
}

tl::expected<void, std::string> check_floats(Bytes file, std::size_t floats) {
  const FloatsJudgement judgement = judge_floats(file);
  if (judgement.kind == FloatsJudgement::Kind::none)
    return tl::unexpected(std::string("does not look like points: nothing in it comes again"));
  if (judgement.kind == FloatsJudgement::Kind::three_or_six)
    return tl::unexpected(std::string("looks like 3 or 6 floats a point"));
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

Hits count_hits(Bytes file, std::size_t floats) {
  Hits hits;
  const std::size_t bytes = floats * sizeof(float);
  for (std::size_t at = 0; at + bytes <= file.size; at += bytes) {
    const std::uint8_t* point = file.data + at;
    hits.add(load_le<float>(point), load_le<float>(point + 4), load_le<float>(point + 8));
  }
  return hits;
}

}  // namespace gvom::ingest
