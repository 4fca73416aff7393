// Times of repeated runs.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace gvom::bench {

class Samples {
 public:
  void add(double time_ms) { times_ms_.push_back(time_ms); }

  /// The time that a share `p` (0 .. 1) of the runs stayed within, ms. There must be a run.
  [[nodiscard]] double quantile_ms(double p) const {
    std::vector<double> sorted = times_ms_;
    std::sort(sorted.begin(), sorted.end());
    const auto last = static_cast<double>(sorted.size() - 1);
    return sorted[static_cast<std::size_t>(p * last + 0.5)];
  }
  [[nodiscard]] std::size_t size() const { return times_ms_.size(); }

 private:
  std::vector<double> times_ms_;
};

/// Times of steps that have names, in the order in which they came first.
class NamedSamples {
 public:
  struct Step {
    std::string name;
    Samples times;
  };

  void add(const std::string& name, double time_ms) {
    const auto same = [&](const Step& step) { return step.name == name; };
    auto step = std::find_if(steps_.begin(), steps_.end(), same);
    if (step == steps_.end()) step = steps_.insert(step, Step{name, {}});
    step->times.add(time_ms);
  }
  [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }

 private:
  std::vector<Step> steps_;
};

/// Runs `work` once; how long it took, ms.
template <class Work>
double time_ms(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace gvom::bench
