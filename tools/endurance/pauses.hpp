// The pauses between rounds, in which nothing is under way: then the counters of all must agree.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ipc/messages.hpp"
#include "tools/endurance/ledger.hpp"
#include "tools/endurance/notes.hpp"

namespace gvom::endurance {

class Pauses {
 public:
  Pauses(std::vector<std::string> lidars, Ledger& ledger) : lidars_(std::move(lidars)), ledger_(ledger) {}

  /// The processes that run before the first packet.
  void note_first(const std::string& process, std::uint32_t pid) { first_pids_[process] = pid; }
  void begin(const RoundNote& through);
  /// A new round begins: what was told in the pause is looked at.
  void end(std::int64_t mono_ns);
  void take(const ipc::Health& health);
  void take(const LayersNote& note);

 private:
  void look(const std::string& process, const ipc::Health& health);

  std::vector<std::string> lidars_;
  Ledger& ledger_;
  std::map<std::string, std::uint32_t> first_pids_;
  std::optional<RoundNote> pause_;
  std::map<std::string, ipc::Health> told_;  // in the pause
  LayersNote newest_{};
  std::uint64_t fusion_life_ = 0;
};

}  // namespace gvom::endurance
