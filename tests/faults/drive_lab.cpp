#include "tests/faults/drive_lab.hpp"

#include <sys/mman.h>

#include <catch2/catch.hpp>
#include <new>

#include "services/common/config_file.hpp"
#include "tests/tools/sim_worlds.hpp"
#include "tools/drive/live/live_session.hpp"

namespace gvom::test {

using namespace std::chrono_literals;
using ipc::test::Child;
using ipc::test::eventually;

namespace {

constexpr double kLength_m = 400;
constexpr double kFull_mps = 4.2;
constexpr double kGoes_mps = 1;
constexpr double kTree_m = 12;  // from one pair of trees to the next
constexpr double kAside_m = 3.5;
constexpr double kForEver_s = 1e6;
constexpr std::chrono::seconds kPatience{120};  // the vehicle and its processes have to work, too

/// Level, and trees on both sides.
driving::CourseWorld make_avenue() {
  sim::WorldData data = level_world();
  data.ground.nodes_x = static_cast<int>((kLength_m + 60) / data.ground.resolution_m) + 1;
  const auto nodes = static_cast<std::size_t>(data.ground.nodes_x) * data.ground.nodes_y;
  data.ground.height_m.assign(nodes, 0.0F);
  data.ground.surface.assign(nodes, sim::Surface::ground);
  data.path_m = {{0, 0}, {kLength_m, 0}};
  for (double x = 5; x < kLength_m; x += kTree_m)
    for (const double y : {-kAside_m, kAside_m}) add(data, sim::Kind::tree, post(x, y, 0.15, 5), 5);
  return {"avenue", std::move(data), {}, {{kLength_m, 0}}};
}

services::VehicleConfig load(const Vehicle& vehicle) {
  return services::load_vehicle_config(vehicle.file, vehicle.sets).value();
}

/// Drives until it is killed.
[[noreturn]] void live_as_vehicle(const Vehicle& vehicle, DriveBoard& board) {
  const driving::CourseWorld course = make_avenue();
  const services::VehicleConfig config = load(vehicle);
  const sim::World world(course.data);
  const sim::GroundTruth truth = sim::sample_truth(world, {0.4, 0.0, 2});
  const driving::TrueObstacles obstacles(world, truth);
  auto runtime = ipc::Runtime::connect("drive-lab", kPatience).value();
  auto session = driving::LiveSession::start(course, world, obstacles, config, {},
                                             driving::LiveBus::open(runtime).value())
                     .value();
  board.is_up = true;
  while (session->step(kForEver_s, {})) {
    const driving::Vehicle& body = session->vehicle().vehicle();
    session->lidar(0).let_send(board.lidar);
    session->vehicle().let_odometry(board.odometry);
    session->vehicle().jump({0, board.jump_m, 0});
    board.speed_mps = body.state().speed_mps;
    board.driven_m = session->log().driven_m;
    board.x_m = body.state().place.x_m;
    board.y_m = body.state().place.y_m;
    board.nearest_m = session->log().nearest_m;
    board.deadlines_passed = session->vehicle().deadlines_passed();
    std::this_thread::sleep_until(session->next());
  }
  board.mishap = session->vehicle().mishap().has_value();
  board.arrived = session->result().outcome == driving::Outcome::arrived;
  ::_exit(0);
}

Vehicle make_vehicle(const std::string& folder) {
  const std::string port = std::to_string(free_port());
  return {GVOM_SOURCE_DIR "/config/vehicles/warthog.yaml",
          {"top"},
          folder,
          {"lidars.top.source=ouster-udp:" + port + "?meta=top.json", "planner.speed_mps=4.5"}};
}

/// Of the newest line of its log.
std::string last_words(const Program& program) {
  std::string log = program.output();
  while (!log.empty() && log.back() == '\n') log.pop_back();
  const std::string line = log.substr(log.rfind('\n') + 1);
  const std::size_t level = line.find("info: ");
  return level == std::string::npos ? line : line.substr(level + 6);
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

DriveLab::DriveLab()
    : board(new (::mmap(nullptr, sizeof(DriveBoard), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1,
                        0)) DriveBoard) {
  const Vehicle vehicle = make_vehicle(folder.path());
  REQUIRE(driving::write_metadata(load(vehicle), {}, folder.path()));
  graph = std::make_unique<Graph>(vehicle);
  observer = std::make_unique<Observer>(folder.path());
  REQUIRE(observer->is_up());
  vehicle_ = std::make_unique<Child>([&] { live_as_vehicle(vehicle, *board); });
  REQUIRE(eventually([this] { return board->is_up.load(); }, kPatience));
  graph->start_readers();
  planner = start_planner();
}

DriveLab::~DriveLab() {
  ::munmap(board, sizeof(DriveBoard));
}

std::unique_ptr<Program> DriveLab::start_planner() const {
  return graph->start("gvom-planner", {});
}

bool DriveLab::drives() const {
  return eventually([this] { return board->speed_mps > kFull_mps; }, kPatience);
}

bool DriveLab::stands() const {
  return eventually([this] { return board->speed_mps < 0.02; }, kPatience);
}

double DriveLab::may_roll_m(double speed_mps, double heard_s) const {
  const driving::VehicleModel model;
  const double brakes_mps2 = load(graph->vehicle()).planner.vehicle.max_decel_mps2;
  return speed_mps * (heard_s + model.delay_s + model.speed_memory_s) +
         speed_mps * speed_mps / (2 * brakes_mps2);
}

Stop DriveLab::check_stop(const std::string& fault, const std::function<void()>& break_it,
                          const std::function<void()>& cure_it) {
  INFO(fault);
  REQUIRE(drives());
  Stop stop{board->speed_mps, -board->driven_m, 0, 0, ""};
  const auto broken = std::chrono::steady_clock::now();
  break_it();
  REQUIRE(stands());
  stop.seconds = seconds_since(broken);
  stop.rolled_m += board->driven_m;
  stop.words = last_words(*planner);
  cure_it();
  const auto cured = std::chrono::steady_clock::now();
  REQUIRE(eventually([this] { return board->speed_mps > kGoes_mps; }, kPatience));
  stop.goes_on_s = seconds_since(cured);
  CHECK_FALSE(board->mishap);
  char seen[256];
  std::snprintf(seen, sizeof seen, "from %.1f m/s to a stand in %.1f s and %.1f m: \"%s\"", stop.speed_mps,
                stop.seconds, stop.rolled_m, stop.words.c_str());
  report(fault, seen, stop.goes_on_s, "");
  return stop;
}

void DriveLab::stop() {
  CHECK(planner->stop() == 0);
  vehicle_.reset();
  graph->stop();
}

}  // namespace gvom::test
