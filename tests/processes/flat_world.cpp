#include "tests/processes/flat_world.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "core/grid.hpp"
#include "core/pose.hpp"
#include "ipc/clock.hpp"
#include "ipc/fixed.hpp"
#include "ipc/layers.hpp"

namespace gvom::test {
namespace {

using namespace std::chrono_literals;

constexpr double kStep_s = 0.02;
constexpr int kStepsPerMap = 5;
constexpr double kBrakes_mps2 = 3;
constexpr float kGround_m = 0.1F;

/// The vehicle and its ends of the topics.
class Drive {
 public:
  Drive(ipc::Runtime& runtime, const services::VehicleConfig& config)
      : config_(config),
        layers_(ipc::LayersPublisher::open(runtime).value()),
        odometry_(ipc::Publisher<ipc::Odometry>::open(runtime).value()),
        course_(ipc::Publisher<ipc::Course>::open(runtime).value()),
        commands_(ipc::Subscriber<ipc::Command>::open(runtime).value()),
        plans_(ipc::Subscriber<ipc::Plan>::open(runtime).value()) {}

  /// True: it had to brake by itself.
  bool move() {
    while (auto command = commands_.take()) newest_ = **command, ++taken_;
    const bool holds = newest_ && ipc::monotonic_ns() < newest_->mono_deadline_ns;
    const bool brakes = newest_ && !holds && speed_mps_ != 0;
    const double wanted_mps = holds ? newest_->speed_mps : 0;
    const double most = kBrakes_mps2 * kStep_s;
    speed_mps_ += std::clamp(wanted_mps - speed_mps_, -most, most);
    const double way_m = speed_mps_ * kStep_s;
    yaw_ += way_m * (holds ? newest_->curvature_per_m : 0);
    x_m_ += way_m * std::cos(yaw_);
    y_m_ += way_m * std::sin(yaw_);
    stamp_ns_ += static_cast<std::int64_t>(kStep_s * 1e9);
    return brakes;
  }

  void publish_odometry() {
    ipc::Odometry message{};
    message.T_odom_base = record_of(pose());
    static_cast<void>(odometry_.publish(message, stamp_ns_, 0));
  }

  void publish_layers(bool front_missing) {
    const MapConfig& map = config_.mapper.map;
    auto writer = layers_.loan(map.size_xy, map.size_z);
    if (!writer) return;
    fill(writer->arrays(), static_cast<std::size_t>(map.size_xy) * map.size_xy);
    ipc::Layers& header = writer->header();
    header.grid = grid_around(map, pose().translation_m);
    header.T_odom_base = record_of(pose());
    header.lidar_count = 1;
    std::strcpy(header.lidars[0].name, "front");
    header.lidars[0].missing = front_missing ? 1 : 0;
    header.mono_received_ns = ipc::monotonic_ns();
    header.suspended_ns = ipc::suspended_ns();
    layers_.publish(std::move(*writer), stamp_ns_, 0);
  }

  void publish_course(const ipc::Course& course) { static_cast<void>(course_.publish(course, stamp_ns_, 0)); }

  [[nodiscard]] double x_m() const { return x_m_; }
  [[nodiscard]] double speed_mps() const { return speed_mps_; }
  [[nodiscard]] std::uint64_t taken() const { return taken_; }
  ipc::Subscriber<ipc::Plan>& plans() { return plans_; }

 private:
  [[nodiscard]] Pose pose() const {
    return {{x_m_, y_m_, 0.0}, Eigen::Quaterniond(Eigen::AngleAxisd(yaw_, Eigen::Vector3d::UnitZ()))};
  }

  static void fill(const LayerArrays& out, std::size_t n) {
    std::fill_n(out.height, n, kGround_m);
    for (float* zero : {out.inferred_height, out.slope_x, out.slope_y, out.slope, out.roughness,
                        out.obstacle_density, out.negative_delta, out.last_seen})
      std::fill_n(zero, n, 0.0F);
    std::fill_n(out.clearance, n, INFINITY);
    std::fill_n(out.flags, n, std::uint8_t{0});
    std::fill_n(out.visibility, n, static_cast<std::uint8_t>(Visibility::ground_seen));
    std::fill_n(out.cost, n, std::uint8_t{0});
  }

  const services::VehicleConfig& config_;
  ipc::LayersPublisher layers_;
  ipc::Publisher<ipc::Odometry> odometry_;
  ipc::Publisher<ipc::Course> course_;
  ipc::Subscriber<ipc::Command> commands_;
  ipc::Subscriber<ipc::Plan> plans_;
  std::optional<ipc::Command> newest_;
  std::uint64_t taken_ = 0;
  double x_m_ = 0, y_m_ = 0, yaw_ = 0, speed_mps_ = 0;
  std::int64_t stamp_ns_ = 1'000'000'000;
};

}  // namespace

FlatWorld::FlatWorld(const services::VehicleConfig& config)
    : state_(new (::mmap(nullptr, sizeof(State), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))
                 State()),
      child_([this, &config] { live(config); }) {
  up_ = up_step_.wait_for(1);
}

FlatWorld::~FlatWorld() {
  ::munmap(state_, sizeof(State));
}

void FlatWorld::send_course(const std::vector<ipc::Course::Place>& places) {
  state_->course = {};
  state_->course.count = static_cast<std::uint32_t>(places.size());
  std::copy(places.begin(), places.end(), state_->course.places);
  state_->new_course = true;
}

std::string FlatWorld::why() const {
  while (true) {
    const int version = state_->why_version;
    const std::string text = state_->why.data();
    if (version % 2 == 0 && version == state_->why_version) return text;
  }
}

void FlatWorld::live(const services::VehicleConfig& config) {
  auto runtime = ipc::Runtime::connect("flat-world", 5s).value();
  Drive drive(runtime, config);
  up_step_.reach(1);
  auto next = std::chrono::steady_clock::now();
  bool braked = false;
  for (int step = 0;; ++step) {
    const bool brakes = drive.move();
    if (brakes && !braked) ++state_->deadlines_passed;
    braked = brakes;
    if (state_->odometry) drive.publish_odometry();
    if (state_->layers && step % kStepsPerMap == 0) drive.publish_layers(state_->front_missing);
    if (state_->new_course.exchange(false)) drive.publish_course(state_->course);
    while (const auto plan = drive.plans().take()) {
      ++state_->why_version;
      std::copy_n((*plan)->why, state_->why.size(), state_->why.begin());
      ++state_->why_version;
      state_->mode = (*plan)->mode;
      state_->waypoint = (*plan)->waypoint;
    }
    state_->x_m = drive.x_m();
    state_->speed_mps = drive.speed_mps();
    state_->commands = drive.taken();
    // After a pause it goes on from where it is: no steps are made up for, which no command could steer.
    next = std::max(next + std::chrono::milliseconds(static_cast<int>(kStep_s * 1000)),
                    std::chrono::steady_clock::now());
    std::this_thread::sleep_until(next);
  }
}

}  // namespace gvom::test
