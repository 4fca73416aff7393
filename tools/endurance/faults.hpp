// Faults made at random moments, one after the other, each with the time until all was well again.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tools/endurance/board.hpp"

namespace gvom::endurance {

struct FaultResult {
  std::string what;
  double at_s;         ///< Of the run.
  double recovered_s;  ///< From the cure (of a kill: from that) until all was well again.
  bool in_time;
};

inline constexpr double kRecovery_s = 10;  ///< All must be well again within it, if nothing else is said.

class Faults {
 public:
  /// What the rest of the soak does for a fault.
  struct Hands {
    std::function<bool(const std::string& process, int signal)> send;  ///< False: no such process.
    std::function<bool(std::int64_t since_ns)> all_is_well;            ///< By news from after that time.
    std::function<void(std::int64_t from_ns, std::int64_t to_ns, const std::string& what)> disturb;
  };

  Faults(std::uint32_t seed, double every_s, double recovery_s, const std::vector<std::string>& lidars,
         Board& board, Hands hands);

  /// Call it often. `may_begin`: a new fault may be made.
  void step(std::int64_t now_ns, double run_s, bool may_begin);
  [[nodiscard]] bool is_under_way() const { return current_.has_value(); }
  [[nodiscard]] const std::vector<FaultResult>& results() const { return results_; }

 private:
  enum class Kind { kill, stop, silence, loss, garbage };
  struct Fault {
    Kind kind;
    std::string target;  // a process, or a lidar's name
    std::size_t lidar;
    double at_s;
    std::int64_t begin_ns;
    std::int64_t cure_ns;
    bool cured;
  };

  Fault draw();
  bool begin(Fault& fault);
  void cure(Fault& fault);
  void watch(Fault& fault, std::int64_t now_ns);
  void set_mode(const Fault& fault, SendMode mode);
  [[nodiscard]] static std::string text_of(const Fault& fault);

  std::mt19937 random_;
  double every_s_;
  double recovery_s_;
  std::vector<std::string> lidars_;
  Board& board_;
  Hands hands_;
  std::int64_t next_ns_ = 0;
  std::optional<Fault> current_;
  std::vector<FaultResult> results_;
};

}  // namespace gvom::endurance
