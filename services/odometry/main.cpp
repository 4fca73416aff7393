// gvom-odometry: publishes T_odom_base from a recording, and is the clock of a replay; or as ROS 2 has it
// now.
#include <spdlog/spdlog.h>

#include "services/common/bus/join.hpp"
#include "services/common/cli.hpp"
#include "services/common/config_concerns.hpp"
#include "services/common/log.hpp"
#include "services/common/odometry_file.hpp"
#include "services/odometry/live.hpp"
#include "services/odometry/rate.hpp"
#include "services/odometry/replay.hpp"

namespace {

using namespace gvom;
using services::ExitCode;

constexpr const char* kName = "gvom-odometry";

struct Options {
  std::string source;
  std::string rate = "1";
  bool loop = false;
  double wait_readers_s = 10.0;
};

void add_options(CLI::App& app, Options& options) {
  app.add_option(
         "--source", options.source,
         "instead of odometry.source: tum:FILE, euroc:FILE, kitti:FILE?times=FILE, bag:PATH?topic=TOPIC, "
         "bag:PATH?tf=PARENT/CHILD or, live, ros2:/TOPIC, ros2:/tf?tf=PARENT/CHILD")
      ->type_name("URI");
  app.add_option("--rate", options.rate,
                 "times the recorded pace, or max: as fast as the slowest reader takes it, losing nothing")
      ->type_name("N|max")
      ->check([](const std::string& text) {
        return odometry::parse_rate(text) ? std::string() : "expected max or a number above 0, at most 1000";
      })
      ->capture_default_str();
  app.add_flag("--loop", options.loop, "begin again at the end, in a new epoch");
  app.add_option("--wait-readers", options.wait_readers_s,
                 "seconds for every lidar and fusion to announce themselves")
      ->type_name("S")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
}

odometry::ReplayOptions replay_options(const Options& options, const services::VehicleConfig& config) {
  const odometry::Rate rate = odometry::parse_rate(options.rate).value();  // checked with the command line
  const std::chrono::duration<double> wait(options.wait_readers_s);
  return {rate.factor, rate.lossless, options.loop,
          std::chrono::duration_cast<std::chrono::milliseconds>(wait), services::config_hash(config, kName)};
}

ExitCode replay(const std::vector<StampedPose>& poses, const std::vector<std::string>& lidars,
                const odometry::ReplayOptions& options, services::Lifecycle& lifecycle) {
  auto runtime = services::join_bus(kName, lifecycle);
  if (!runtime) return runtime.error();
  auto bus = odometry::Bus::open(*runtime);
  if (!bus) {
    spdlog::error("{}", bus.error().message);
    return services::exit_code_of(bus.error());
  }
  services::notify_ready();
  const ExitCode code = odometry::Replay(poses, lidars, options, *runtime, *bus, lifecycle).run();
  services::notify_stopping();
  return code;
}

ExitCode live(const std::string& source, const services::VehicleConfig& config,
              services::Lifecycle& lifecycle) {
  if (const std::string fault = odometry::fault_of(source); !fault.empty()) {
    spdlog::error("{}", fault);
    return ExitCode::configuration;
  }
  auto runtime = services::join_bus(kName, lifecycle);
  if (!runtime) return runtime.error();
  return odometry::run_live(source, services::config_hash(config, kName), *runtime, lifecycle);
}

}  // namespace

int main(int argc, char** argv) {
  services::Lifecycle lifecycle(services::kLeaveWithin);
  services::Cli cli(kName,
                    "Publishes the odometry of a recording, as the clock of its replay, or of ROS 2 live.");
  Options options;
  add_options(cli.app(), options);
  cli.app().footer("Example:\n  gvom-odometry --config vehicle.yaml --source tum:odometry.tum --rate max");
  const auto config = cli.parse(argc, argv);
  if (!config) return to_int(config.error());

  services::init_logging(kName);
  const std::string& source = options.source.empty() ? config->odometry.source : options.source;
  if (source.empty()) {
    spdlog::error("{}: odometry.source is empty: give one there or with --source URI", config->path);
    return to_int(ExitCode::configuration);
  }
  if (odometry::is_live(source)) return to_int(live(source, *config, lifecycle));
  std::vector<std::string> warnings;
  const auto poses = services::read_odometry_source(source, warnings);
  if (!poses) {
    spdlog::error("{}", poses.error());
    return to_int(ExitCode::bad_data);
  }
  for (const std::string& warning : warnings) spdlog::warn("{}", warning);
  std::vector<std::string> lidars;
  for (const services::LidarConfig& lidar : config->lidars) lidars.push_back(lidar.name);
  return to_int(replay(*poses, lidars, replay_options(options, *config), lifecycle));
}
