// Whether all that went in came out or was counted as lost, by the processes' own counters while nothing was
// under way.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/common/health_view.hpp"

namespace gvom::endurance {

/// The difference between what went in and what was counted, looked at again and again. What is still under
/// way makes it differ for once; what was lost stays.
class Balance {
 public:
  /// `from_zero`: nothing had gone in before the first look. Else the first looks say where it began.
  explicit Balance(bool from_zero = true) : from_zero_(from_zero) {}
  void look(std::int64_t difference);
  /// That nobody counted: above 0 lost, below 0 made of nothing; 0 while there were too few looks.
  [[nodiscard]] std::int64_t uncounted() const;
  [[nodiscard]] std::uint64_t looks() const { return looks_; }

 private:
  static constexpr std::size_t kLooks = 3;
  bool from_zero_;
  std::uint64_t looks_ = 0;
  std::array<std::int64_t, kLooks> first_{};
  std::array<std::int64_t, kLooks> newest_{};
};

/// What the rest of the graph had counted when a process told its Health in a pause between two rounds.
struct Pause {
  bool first_life = true;         ///< The process has run since before the first packet.
  std::uint64_t packets = 0;      ///< Sent to the lidar.
  std::uint64_t fusion_life = 0;  ///< Which start of fusion the next two are of; 0: none was heard of.
  std::uint64_t maps = 0;         ///< Of the lidar, that fusion took or counted as lost.
  std::uint64_t layers = 0;       ///< Sequence of the newest layers.
};

class Ledger {
 public:
  /// `process` with its pid: each start is one of its own.
  void look_at_ingest(const std::string& process, const tools::Counters& counters, const Pause& pause);
  void look_at_fusion(const std::string& process, const tools::Counters& counters, const Pause& pause);

  [[nodiscard]] std::uint64_t looks() const;
  /// In words, what was lost and not counted.
  [[nodiscard]] std::vector<std::string> defects() const;

 private:
  Balance& balance(const std::string& what, bool from_zero);
  std::map<std::string, Balance> balances_;
};

}  // namespace gvom::endurance
