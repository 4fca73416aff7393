// gvom-planner: drives by the layers, the reference planner.
#include <spdlog/spdlog.h>

#include "services/common/bus/join.hpp"
#include "services/common/cli.hpp"
#include "services/common/lifecycle.hpp"
#include "services/common/log.hpp"
#include "services/planner/process/course_file.hpp"
#include "services/planner/process/planner_node.hpp"

namespace {

using namespace gvom;
using services::ExitCode;

constexpr const char* kName = "gvom-planner";

ExitCode run(const services::VehicleConfig& config, const std::vector<Eigen::Vector2d>& course,
             services::Lifecycle& lifecycle) {
  auto runtime = services::join_bus(kName, lifecycle);
  if (!runtime) return runtime.error();
  static_cast<void>(services::ready_payloads(*runtime));
  auto bus = planner::Bus::open(*runtime);
  if (!bus) {
    spdlog::error("{}", bus.error().message);
    return services::exit_code_of(bus.error());
  }
  return planner::PlannerNode(config, *runtime, *bus, lifecycle, course).run();
}

}  // namespace

int main(int argc, char** argv) {
  services::Lifecycle lifecycle(services::kLeaveWithin);
  services::Cli cli(kName, "Plans by the layers: publishes a plan and commands to the vehicle.");
  std::string course_path;
  cli.app()
      .add_option("--course", course_path, "places to drive to, x_m,y_m in odom, one a line; else by the bus")
      ->type_name("FILE.csv");
  cli.app().footer("Example:\n  gvom-planner --config vehicle.yaml --course waypoints.csv");
  const auto config = cli.parse(argc, argv);
  if (!config) return services::to_int(config.error());
  services::init_logging(kName);
  std::vector<Eigen::Vector2d> course;
  if (!course_path.empty()) {
    auto read = planner::read_course(course_path, ipc::Course::kMaxPlaces);
    if (!read) {
      spdlog::error("{}", read.error());
      return services::to_int(ExitCode::bad_data);
    }
    course = std::move(*read);
  }
  return services::to_int(run(*config, course, lifecycle));
}
