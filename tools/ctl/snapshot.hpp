// How the vehicle's processes are at one moment: what every output of gvomctl shows.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ipc/freshness.hpp"
#include "ipc/pools.hpp"
#include "tools/common/health_view.hpp"
#include "tools/common/process_usage.hpp"
#include "tools/ctl/observed.hpp"

namespace gvom::ctl {

inline constexpr char kBroker[] = "gvom-roudi";
/// No vehicle's file asks for these: they are missed only where systemd says that their unit has failed.
inline constexpr const char* kByChoice[] = {"gvom-planner", "gvom-bridge"};

/// The broker, by a look from outside (ipc/broker_probe.hpp) and by joining its bus.
enum class BrokerState { absent, hung, up };

struct Broker {
  BrokerState state = BrokerState::absent;
  bool joined = false;  ///< Its bus, by us.
  std::optional<std::uint32_t> pid;
  std::string note;  ///< Why it is absent, else the bus's last complaint, such as why it could not be joined.
};

/// Which processes the vehicle's file asks for.
struct Expected {
  std::string vehicle;                 ///< Empty: no file was given, nothing is missed.
  std::vector<std::string> processes;  ///< Runtime names, in the order in which they are shown.
  std::string version;                 ///< Of this gvom; empty: not compared.
  std::vector<ipc::Pool> pools = {};   ///< That the broker makes for the file; empty: not known.
  std::optional<std::uint64_t> config_hash = std::nullopt;   ///< Of the file.
  std::map<std::string, std::uint64_t> process_hashes = {};  ///< Of what in it concerns each process.
  std::string config_error = {};  ///< Why the file does not load: then nothing else of it is known.
};

/// What is known of processes but from the bus.
struct Surroundings {
  std::function<std::optional<tools::Usage>(std::uint32_t pid)> usage;
  std::function<std::optional<std::uint64_t>(const std::string& process)> restarts;
  std::function<std::string(const std::string& process)> why_not_running;  ///< Empty: nothing to say.
  std::function<bool(const std::string& process)> has_failed = {};         ///< By systemd, for good.
};

/// A process's own word of itself, or what can be told of one that does not speak: silent, it is there; hung,
/// it takes no messages (the broker); missing, it is not there; unknown, the bus is not heard.
enum class ProcessState { starting, ok, degraded, failed, stopping, silent, hung, missing, unknown };
inline constexpr int kProcessStates = 9;

struct Drop {
  std::string reason;           ///< The counter's name without "drop_".
  std::uint64_t count;          ///< Since the process started.
  std::optional<double> per_s;  ///< Between its last two Healths.
};

/// Where a lidar sees the ground, against where the vehicle's file puts it.
struct GroundView {
  ipc::GroundVerdict verdict;
  std::uint32_t sweeps;  ///< 0: none was found, and the numbers say nothing.
  double height_m;       ///< Above it.
  double slope_x;        ///< In base_link, m/m.
  double slope_y;
  bool on_the_way;
};

struct ProcessView {
  std::string name;
  ProcessState state = ProcessState::missing;
  std::string reason;  ///< Why it is not ok, in words.
  std::optional<std::uint32_t> pid;
  std::optional<double> rate_hz;       ///< Of its product.
  std::optional<double> health_age_s;  ///< Of its last Health.
  std::optional<double> data_age_s;    ///< Fusion: of the packets in its layers; a lidar: of its newest map.
  std::vector<Drop> drops;             ///< Those that are not 0.
  tools::Counters counters;
  std::vector<ipc::Health::Stage> stages;
  std::optional<std::uint64_t> restarts;  ///< By systemd, since the unit was started by hand.
  std::optional<tools::Usage> usage;
  std::optional<GroundView> ground;  ///< Of a lidar.
  std::string backend;
  std::string backend_details;
  std::string version;         ///< Of gvom; empty: not known.
  std::string config_hash;     ///< 16 hexadecimal digits; empty: not known.
  bool other_version = false;  ///< Than this gvom's.
  bool other_config = false;   ///< Than the file's.
};

struct LidarView {
  std::string name;
  bool missing;
  std::uint32_t maps_in_window;
  std::uint64_t maps_lost;
  double columns_seen_fraction;  ///< Of its newest sweep; 1: complete. 0: none came.
  bool unknown;                  ///< It publishes maps, but fusion's configuration does not have it.
};

struct LayersView {
  double age_s;          ///< Of the data, as ipc/freshness.hpp has it; infinite: unknown.
  double publish_age_s;  ///< Since they were published.
  std::uint32_t maps_in_window;
  std::vector<LidarView> lidars;
};

struct OdometryView {
  double age_s;  ///< Since the last one was heard, to 0.1 s.
  std::optional<double> rate_hz;
};

struct Snapshot {
  std::string vehicle;
  std::string config_error;  ///< Why the vehicle's file does not load.
  std::string version;       ///< Of this gvom.
  std::string config_hash;   ///< Of the file, 16 hexadecimal digits; empty without one.
  Broker broker;
  std::vector<ProcessView> processes;  ///< The broker first.
  std::optional<LayersView> layers;
  std::optional<OdometryView> odometry;
  std::vector<ipc::PoolUse> pools;
  std::vector<std::string> refusals;  ///< Why messages were not read, each reason once.
  std::vector<std::string> problems;  ///< Everything that is not as it should be; empty: all is well.
};

/// From level.
double tilt_degrees(const GroundView& ground);

/// "none", "not judged", "well" or "wrong".
const char* to_string(ipc::GroundVerdict verdict);

/// "starting", "ok", ..., "unknown".
const char* to_string(ProcessState state);

/// Whether the broker, which tells no configuration, has the pools of another one. False while either is not
/// known.
bool has_other_pools(const std::vector<ipc::PoolUse>& there, const std::vector<ipc::Pool>& expected);

/// What is not as it should be, in words; empty: all is well.
std::vector<std::string> problems_of(const Snapshot& snapshot);

Snapshot assess(const Broker& broker, const Observed& observed, const Expected& expected,
                const Surroundings& surroundings, const ipc::Moment& now);

/// Whether a longer look would tell no more: all that is expected was heard twice, and so on.
bool is_complete(const Observed& observed, const Expected& expected);

}  // namespace gvom::ctl
