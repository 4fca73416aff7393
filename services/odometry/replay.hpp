// The replay itself: publishes the poses of a recording and is the clock of everything that reads them.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/pose.hpp"
#include "ipc/fixed.hpp"
#include "ipc/runtime.hpp"
#include "ipc/waiter.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/health.hpp"
#include "services/common/lifecycle.hpp"
#include "services/odometry/readers.hpp"

namespace gvom::odometry {

/// Most odometry messages that a lossless replay is ahead of its slowest reader: an eighth of a reader's
/// queue.
inline constexpr std::uint64_t kMostAhead = 32;

struct ReplayOptions {
  double rate = 1.0;      ///< Times the recorded pace.
  bool lossless = false;  ///< As fast as the slowest reader takes it, instead of `rate`.
  bool loop = false;
  std::chrono::milliseconds wait_readers{10000};
  std::uint64_t config_hash = 0;  ///< For Health.
};

/// This process's ends of the topics.
struct Bus {
  ipc::Publisher<ipc::Odometry> odometry;
  ipc::Publisher<ipc::Health> health;
  ipc::Subscriber<ipc::Progress> progress;
  ipc::Waiter waiter;

  static ipc::Expected<Bus> open(ipc::Runtime& runtime);
};

class Replay {
 public:
  /// All references outlive the replay. `lidars`: the names of the readers that are waited for.
  Replay(const std::vector<StampedPose>& poses, const std::vector<std::string>& lidars,
         const ReplayOptions& options, ipc::Runtime& runtime, Bus& bus, services::Lifecycle& lifecycle);
  ~Replay();

  /// Until the recording is through and read, or a stop (both ok), or a reader keeps a lossless replay
  /// waiting (try_again).
  services::ExitCode run();

 private:
  using Outcome = tl::expected<void, services::ExitCode>;  // an error ends the replay with that code

  Outcome wait_for_readers();
  Outcome play_round();
  Outcome wait_for_room();
  Outcome wait_until(std::chrono::steady_clock::time_point deadline);
  Outcome drain();
  Outcome publish(const StampedPose& pose, std::uint32_t flags);
  Outcome serve(std::chrono::milliseconds timeout);
  void take_progress();
  void publish_health();

  const std::vector<StampedPose>& poses_;
  const ReplayOptions options_;
  Bus& bus_;
  services::Lifecycle& lifecycle_;
  services::BrokerWatch broker_;
  std::uint64_t epoch_;
  Readers readers_;
  services::HealthReport health_;
  std::uint64_t& published_;
  std::uint64_t& rounds_;
  std::uint64_t& restarts_;
  std::uint64_t& foreign_;
  services::StageHistogram& lateness_;
};

}  // namespace gvom::odometry
