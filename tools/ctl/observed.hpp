// What was heard on the bus: the newest of each message, and enough of the past for rates.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ipc/messages.hpp"
#include "ipc/pool_use.hpp"

namespace gvom::ctl {

struct HeardProcess {
  ipc::Health newest;
  std::optional<ipc::Health> before;  ///< The Health before it, of the same process id.
};

struct HeardOdometry {
  std::int64_t mono_ns = 0;       ///< When it was heard.
  std::optional<double> rate_hz;  ///< Over the last second or more.
};

class Observed {
 public:
  void add(const ipc::Health& health);
  void add(const ipc::Layers& layers) { layers_ = layers; }
  void add(const ipc::MessageHeader& odometry, std::int64_t heard_mono_ns);
  void add(std::vector<ipc::PoolUse> pools) { pools_ = std::move(pools); }
  /// Why a message was not read.
  void add_refusal(const std::string& why);

  [[nodiscard]] const std::vector<HeardProcess>& processes() const { return processes_; }
  /// Null if it was never heard.
  [[nodiscard]] const HeardProcess* find(const std::string& process) const;
  [[nodiscard]] const std::optional<ipc::Layers>& layers() const { return layers_; }  ///< Their header.
  [[nodiscard]] const std::optional<HeardOdometry>& odometry() const { return odometry_; }
  [[nodiscard]] const std::vector<ipc::PoolUse>& pools() const { return pools_; }
  [[nodiscard]] const std::vector<std::string>& refusals() const { return refusals_; }

 private:
  std::vector<HeardProcess> processes_;
  std::optional<ipc::Layers> layers_;
  std::optional<HeardOdometry> odometry_;
  std::uint64_t rate_from_sequence_ = 0;
  std::int64_t rate_from_ns_ = 0;
  std::vector<ipc::PoolUse> pools_;
  std::vector<std::string> refusals_;
};

}  // namespace gvom::ctl
