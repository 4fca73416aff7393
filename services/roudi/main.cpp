// gvom-roudi: the shared-memory broker, with pools for this vehicle. Start it first, stop it last.
#include <spdlog/spdlog.h>

#include <chrono>

#include "ipc/broker.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/bus/pool_spec.hpp"
#include "services/common/cli.hpp"
#include "services/common/lifecycle.hpp"
#include "services/common/log.hpp"

namespace {

using namespace gvom;
using services::ExitCode;

/// It gives back gigabytes of memory.
constexpr std::chrono::seconds kLeaveWithin{4};

tl::expected<void, services::ConfigError> check_pools(const services::VehicleConfig& config) {
  const auto plan = ipc::plan_pools(services::pool_spec(config));
  if (plan) return {};
  return tl::unexpected(services::ConfigError{config.path, "", plan.error().message});
}

ExitCode serve(const services::VehicleConfig& config, services::Lifecycle& lifecycle) {
  const ipc::PoolPlan plan =
      ipc::plan_pools(services::pool_spec(config)).value();  // checked with the configuration
  for (const ipc::Pool& pool : plan.pools) {
    spdlog::debug("pool: {} chunks of {} bytes", pool.chunks, pool.chunk_bytes);
  }
  const auto log = [](const std::string& line) { spdlog::error("{}", line); };
  const auto start = std::chrono::steady_clock::now();
  const auto broker = ipc::Broker::start({plan, services::notify_watchdog, log});
  if (!broker) {
    spdlog::critical("{}", broker.error().message);
    return services::exit_code_of(broker.error());
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  spdlog::info(
      "broker for '{}' is up after {:.1f} s: {:.0f} MB of shared memory, {:.0f} MB of it in {} pools",
      config.name, took.count(), static_cast<double>(ipc::shared_memory_bytes(plan)) * 1e-6,
      static_cast<double>(plan.total_bytes) * 1e-6, plan.pools.size());
  services::notify_status(
      fmt::format("{:.0f} MB of shared memory", static_cast<double>(ipc::shared_memory_bytes(plan)) * 1e-6)
          .c_str());
  services::notify_ready();
  while (!lifecycle.stopping())
    lifecycle.sleep_until(std::chrono::steady_clock::now() + std::chrono::hours(1));
  services::notify_stopping();
  spdlog::info("broker stops");
  return ExitCode::ok;
}

}  // namespace

int main(int argc, char** argv) {
  services::Lifecycle lifecycle(kLeaveWithin);
  services::Cli cli("gvom-roudi", "The shared-memory broker: start it first, stop it last.");
  cli.also_check(check_pools);
  cli.app().footer("Example:\n  gvom-roudi --config vehicle.yaml --print-config   all keys and their values");
  const auto config = cli.parse(argc, argv);
  if (!config) return services::to_int(config.error());
  services::init_logging("gvom-roudi");
  return services::to_int(serve(*config, lifecycle));
}
