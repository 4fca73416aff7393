#include "tools/drive/live/run_live.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "services/common/bus/join.hpp"
#include "tools/common/broker_user.hpp"

namespace gvom::driving {
namespace {

using services::ExitCode;

tl::unexpected<ExitCode> fail(ExitCode code, const std::string& message) {
  spdlog::error("{}", message);
  return tl::unexpected(code);
}

}  // namespace

tl::expected<LiveResult, ExitCode> run_live(const CourseWorld& course, const services::VehicleConfig& config,
                                            const SessionOptions& options, const std::string& folder,
                                            services::Lifecycle& lifecycle, const Onlooker& onlooker) {
  const sim::World world(course.data);
  const sim::GroundTruth truth = sim::sample_truth(world, {config.mapper.map.resolution_xy_m, 0.0, 1});
  const TrueObstacles obstacles(world, truth);
  const auto way = true_way(truth, course, config.planner);
  std::filesystem::create_directories(folder);
  if (const auto written = write_metadata(config, options, folder); !written)
    return fail(ExitCode::bad_data, written.error());
  if (!tools::become_broker_user())
    return fail(ExitCode::unavailable,
                std::string("cannot become the user that the broker runs as: ") + std::strerror(errno));
  auto runtime = services::join_bus("gvom-drive", lifecycle);
  if (!runtime) return tl::unexpected(runtime.error());
  auto bus = LiveBus::open(*runtime);
  if (!bus) return fail(services::exit_code_of(bus.error()), bus.error().message);
  auto session = LiveSession::start(course, world, obstacles, config, options, std::move(*bus));
  if (!session) return fail(ExitCode::unavailable, session.error());
  spdlog::info("the vehicle stands at its start, {} lidars turn", config.lidars.size());
  const double most_s = most_seconds(options, way);
  while (lifecycle.sleep_until((*session)->next()) && runtime->broker_alive() &&
         (*session)->step(most_s, onlooker)) {
  }
  if (!runtime->broker_alive()) {
    spdlog::error("the broker is gone: {}", (*session)->figures());
    ::_exit(to_int(ExitCode::try_again));  // destructors of ports without a broker can hang
  }
  LiveResult result{(*session)->result(), (*session)->figures()};
  result.session.way = way;
  return result;
}

}  // namespace gvom::driving
