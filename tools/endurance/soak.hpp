// The soak itself: feeds the graph, listens to it, makes faults, and keeps the book.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/common/exit_code.hpp"
#include "services/common/lifecycle.hpp"
#include "tools/endurance/channel.hpp"
#include "tools/endurance/keeper.hpp"
#include "tools/endurance/pauses.hpp"
#include "tools/endurance/recording.hpp"
#include "tools/endurance/sampler.hpp"
#include "tools/endurance/verdict.hpp"

namespace gvom::endurance {

struct SoakOptions {
  std::string out;  ///< Folder of the samples and the verdict.
  double minutes = 1;
  bool faults = false;
  double fault_every_s = 20;
  double recovery_s = kRecovery_s;
  std::uint32_t seed = 1;
  std::vector<std::string> lidars;
  std::vector<std::uint16_t> ports;  ///< Of each lidar.
};

class Soak {
 public:
  /// `supervisor`: null where systemd keeps the processes running. All references outlive it.
  Soak(const SoakOptions& options, const Recording& recording, Board& board, Supervisor* supervisor,
       services::Lifecycle& lifecycle);

  /// Until the time is over, a stop, or a process that cannot go on. Unavailable if the graph did not come up
  /// or the files can't be written.
  services::ExitCode run();
  /// verdict.json in `out`, and what failed on stdout; true if all is well.
  bool write_verdict();

 private:
  void step();
  bool wait_until_up();
  void feed();
  void finish();
  void receive();
  bool drain(int socket);
  void take(const Note& note);
  void take_layers(const LayersNote& note);
  void take_round(const RoundNote& note, bool begins);
  [[nodiscard]] std::vector<std::pair<std::string, pid_t>> processes() const;
  [[nodiscard]] Faults::Hands hands();
  [[nodiscard]] bool all_is_well(std::int64_t since_ns) const;

  const SoakOptions& options_;
  Board& board_;
  services::Lifecycle& lifecycle_;
  Supervisor* supervisor_;
  std::optional<Watchdog> watchdog_;
  Child feeder_;
  ListenerKeeper listener_;
  RoundBook rounds_;
  Ledger ledger_;
  Pauses pauses_;
  HealthWatch health_;
  Sampler sampler_;
  Faults faults_;
  std::size_t faults_told_ = 0;
  Run run_;
  bool feeding_ = false;
  bool round_is_open_ = false;
  std::int64_t unsteady_ns_ = 0;  // when last a round began or ended, or a fault was under way
  LayersNote newest_layers_{};
};

}  // namespace gvom::endurance
