// What the processes say of themselves, once a second: what they lost, what they complain of, who began anew.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "ipc/messages.hpp"
#include "tools/endurance/rounds.hpp"

namespace gvom::endurance {

class HealthWatch {
 public:
  explicit HealthWatch(std::vector<std::string> expected) : expected_(std::move(expected)) {}

  /// What was lost, and who began anew, disturbs the rounds since the Health before. What it complains of is
  /// noted.
  void take(const ipc::Health& health, RoundBook& rounds);
  /// A process that has said nothing for a while.
  void look_for_silence(std::int64_t now_ns, RoundBook& rounds) const;

  [[nodiscard]] const std::vector<std::string>& expected() const { return expected_; }
  /// Null if it was never heard.
  [[nodiscard]] const ipc::Health* newest(const std::string& process) const;
  [[nodiscard]] bool all_heard() const;
  /// All said after `since_ns` that they are ok.
  [[nodiscard]] bool all_ok(std::int64_t since_ns) const;

  [[nodiscard]] const std::map<std::string, std::uint64_t>& losses() const { return losses_; }
  struct Complaint {
    std::uint64_t messages = 0;
    std::string newest;  ///< In words.
  };
  [[nodiscard]] const std::map<std::string, Complaint>& complaints() const { return complaints_; }
  [[nodiscard]] const std::map<std::string, std::uint64_t>& restarts() const { return restarts_; }

 private:
  void compare(const std::string& process, const ipc::Health& before, const ipc::Health& health,
               RoundBook& rounds);

  std::vector<std::string> expected_;
  std::map<std::string, ipc::Health> newest_;
  std::map<std::string, std::uint64_t> losses_;
  std::map<std::string, Complaint> complaints_;
  std::map<std::string, std::uint64_t> restarts_;
};

}  // namespace gvom::endurance
