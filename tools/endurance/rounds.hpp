// The rounds of the loop: which were clean, and whether their layers were those of the rounds before.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "tools/endurance/notes.hpp"

namespace gvom::endurance {

class RoundBook {
 public:
  /// `sweeps`: of each lidar in one round.
  explicit RoundBook(std::vector<std::uint64_t> sweeps) : sweeps_(std::move(sweeps)) {}

  void begin(std::uint64_t epoch);
  /// Its packets are through; a round that another one cuts short is not whole.
  void end(std::uint64_t epoch, std::int64_t mono_ns);
  void add(const LayersNote& note);
  /// Between these times something was lost and counted, or was not as it should be. A round that this
  /// touches is not compared.
  void disturb(std::int64_t from_ns, std::int64_t to_ns, const std::string& what);
  /// Judges the rounds that ended so long ago that every process has told its counters since.
  void settle(std::int64_t now_ns);

  [[nodiscard]] std::uint64_t rounds() const { return rounds_; }  ///< Judged.
  [[nodiscard]] std::uint64_t clean() const { return clean_; }
  [[nodiscard]] std::uint64_t compared() const {
    return compared_;
  }                                                             ///< Layers, with those of another round.
  [[nodiscard]] std::uint64_t wrong() const { return wrong_; }  ///< ... that differed.
  [[nodiscard]] std::uint64_t keys() const { return known_.size(); }
  /// What disturbed rounds, and how many each.
  [[nodiscard]] const std::map<std::string, std::uint64_t>& disturbances() const { return causes_; }
  /// Defects: layers that differ, maps of a clean round that nobody counted. The first few, in words.
  [[nodiscard]] const std::vector<std::string>& defects() const { return defects_; }
  [[nodiscard]] std::uint64_t defect_count() const { return defect_count_; }

 private:
  struct Round {
    std::uint64_t epoch;
    std::int64_t end_ns = 0;  // 0: not through
    std::vector<LayersNote> notes;
  };
  struct Disturbance {
    std::int64_t from_ns;
    std::int64_t to_ns;
    std::string what;
  };

  bool is_disturbed(const Round& round, std::int64_t next_ns);
  void judge(const Round& round, const Round* next);
  void compare(const Round& round);
  void check_maps(const Round& round, const Round& next);
  void add_defect(std::string what);

  std::vector<std::uint64_t> sweeps_;
  std::deque<Round> open_;  // oldest first
  std::deque<Disturbance> disturbances_;
  LayersNote before_{};                                     // the newest layers of the round judged last
  std::unordered_map<std::uint64_t, std::uint64_t> known_;  // checksums by key
  std::uint64_t rounds_ = 0;
  std::uint64_t clean_ = 0;
  std::uint64_t compared_ = 0;
  std::uint64_t wrong_ = 0;
  std::map<std::string, std::uint64_t> causes_;
  std::vector<std::string> defects_;
  std::uint64_t defect_count_ = 0;
};

}  // namespace gvom::endurance
