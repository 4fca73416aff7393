// After start-up, ingest and fusion allocate nothing: a thousand sweeps over a real bus, counted.
#include <catch2/catch.hpp>

#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <fstream>

#include "services/common/bus/join.hpp"
#include "services/common/config_file.hpp"
#include "services/common/lifecycle.hpp"
#include "services/fusion/fusion_node.hpp"
#include "services/ingest/ingest_node.hpp"
#include "tests/ipc/processes.hpp"
#include "tests/processes/counted_memory.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using gvom::ipc::test::Child;
using gvom::ipc::test::eventually;

namespace {

constexpr std::uint64_t kWarmUp = 50;  // sweeps
constexpr std::uint64_t kSweeps = 1000;
constexpr long kMostFaults = 20;
constexpr std::int64_t kPeriod_ns = 100'000'000;
constexpr char kNotifySocket[] = "/tmp/notify";

/// What the processes share.
struct Shared {
  AllocationCount ingest;
  AllocationCount fusion;
  std::atomic<std::uint64_t> sweeps{0};
  std::atomic<long> ingest_faults{0};
  std::atomic<long> fusion_faults{0};
};

/// A short recording again and again, time going on: only the going back is not counted. Turns the counting
/// on and off as sweeps pass.
class EndlessSource : public ingest::Source {
 public:
  EndlessSource(std::unique_ptr<ingest::Source> recording, Shared& shared)
      : recording_(std::move(recording)), shared_(shared) {}

  tl::expected<ingest::SourceEvent, std::string> next(Sweep& out,
                                                      std::chrono::milliseconds timeout) override {
    if (shared_.sweeps == kWarmUp + kSweeps) return ingest::SourceEvent::kEnd;
    auto event = recording_->next(out, timeout);
    if (event && *event == ingest::SourceEvent::kEnd) {
      const NotCounted pause;
      offset_ns_ += sweeps_in_round_ * kPeriod_ns;
      sweeps_in_round_ = 0;
      EXPECT(recording_->rewind());
      event = recording_->next(out, timeout);
    }
    EXPECT(event && *event == ingest::SourceEvent::kSweep);
    ++sweeps_in_round_;
    out.stamp_ns += offset_ns_;
    for (std::int64_t& time_ns : out.times_ns) time_ns += offset_ns_;
    const std::uint64_t sweeps = ++shared_.sweeps;
    if (sweeps == kWarmUp) shared_.ingest.counting = shared_.fusion.counting = true;
    if (sweeps == kWarmUp + kSweeps) shared_.ingest.counting = shared_.fusion.counting = false;
    return event;
  }
  tl::expected<void, std::string> rewind() override { return {}; }
  [[nodiscard]] bool is_live() const override { return false; }
  void set_time_hint(std::int64_t stamp_ns) override { recording_->set_time_hint(stamp_ns); }
  [[nodiscard]] const ingest::SourceCounters& counters() const override { return recording_->counters(); }
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return recording_->warnings(); }

 private:
  std::unique_ptr<ingest::Source> recording_;
  Shared& shared_;
  std::int64_t offset_ns_ = 0;
  std::int64_t sweeps_in_round_ = 0;
};

/// Page faults of this process between the first and the last counted sweep.
class FaultWatch {
 public:
  FaultWatch(AllocationCount& count, std::atomic<long>& faults)
      : thread_([&] {
          while (!count.counting) std::this_thread::sleep_for(std::chrono::milliseconds(1));
          const long before = faults_so_far();
          while (count.counting) std::this_thread::sleep_for(std::chrono::milliseconds(1));
          faults = faults_so_far() - before;
        }) {}
  ~FaultWatch() { thread_.join(); }
  FaultWatch(const FaultWatch&) = delete;
  FaultWatch& operator=(const FaultWatch&) = delete;

 private:
  static long faults_so_far() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt + usage.ru_majflt;
  }
  std::thread thread_;
};

services::VehicleConfig configuration(const Vehicle& vehicle) {
  auto config = services::load_vehicle_config(vehicle.file, vehicle.sets);
  EXPECT(config);
  return std::move(*config);
}

void ingest_life(const Vehicle& vehicle, Shared& shared) {
  services::Lifecycle lifecycle;
  const auto config = configuration(vehicle);
  const services::LidarConfig& lidar = config.lidars.front();
  auto recording = ingest::open_source(lidar.source, {lidar.min_sweep_fraction, 65536});
  EXPECT(recording);
  auto runtime = services::join_bus("gvom-ingest-front", lifecycle);
  EXPECT(runtime);
  auto bus = ingest::Bus::open(*runtime, config, lidar.name);
  EXPECT(bus);
  EXPECT(runtime->prefault());
  count_allocations(shared.ingest);
  const FaultWatch faults(shared.ingest, shared.ingest_faults);
  const services::DeviceTrust trust(lidar.backend, "");
  ingest::IngestNode node(
      config, lidar, *runtime, *bus, lifecycle,
      {std::make_unique<EndlessSource>(std::move(*recording), shared),
       trust,
       {std::make_unique<cpu::Voxelizer>(config.mapper.map, lidar.geometry, config.mapper.vehicle, 65536),
        "cpu", "in a test"}});
  EXPECT(node.run() == services::ExitCode::ok);
}

void fusion_life(const Vehicle& vehicle, Shared& shared) {
  services::Lifecycle lifecycle;
  const auto config = configuration(vehicle);
  auto runtime = services::join_bus("gvom-fusion", lifecycle);
  EXPECT(runtime);
  auto bus = fusion::Bus::open(*runtime, config);
  EXPECT(bus);
  EXPECT(runtime->prefault());
  count_allocations(shared.fusion);
  const FaultWatch faults(shared.fusion, shared.fusion_faults);
  const services::DeviceTrust trust(config.fusion.backend, "");
  fusion::FusionNode node(config, *runtime, *bus, lifecycle, trust,
                          {std::make_unique<cpu::Fusion>(config.mapper), "cpu", "in a test"});
  EXPECT(node.run() == services::ExitCode::ok);
}

/// Stands in for systemd, so that telling it is counted too.
void notify_life() {
  const int fd = ::socket(AF_UNIX, SOCK_DGRAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy(std::begin(kNotifySocket), std::end(kNotifySocket), address.sun_path);
  EXPECT(::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  char text[4096];
  while (::recv(fd, text, sizeof text, 0) > 0) continue;
}

/// A long drive: poses every 50 ms from before the first sweep to after the last, slowly forward and round.
void write_odometry(const std::string& path) {
  std::ofstream file(path);
  file.precision(12);
  const int poses = static_cast<int>(kWarmUp + kSweeps + 20) * 2;
  for (int i = 0; i < poses; ++i) {
    const double time_s = 999.9 + 0.05 * i;
    const double angle_rad = 0.02 * 0.05 * i;
    file << time_s << " " << 20 * std::sin(angle_rad) << " " << 20 - 20 * std::cos(angle_rad) << " 0 0 0 "
         << std::sin(angle_rad / 2) << " " << std::cos(angle_rad / 2) << "\n";
  }
}

}  // namespace

TEST_CASE("ingest and fusion allocate nothing in a thousand sweeps") {
  const TemporaryFolder folder;
  simulated(folder.path(), 1);
  write_odometry(folder.path() + "/odometry.tum");
  Vehicle vehicle = front_only(folder.path());
  Graph graph(vehicle);
  vehicle.sets.push_back("lidars.front.source=ouster:" + folder.path() + "/front.pcap?meta=" + folder.path() +
                         "/front.json");
  void* memory = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  Shared& shared = *new (memory) Shared;
  Child systemd(notify_life);
  ::setenv("NOTIFY_SOCKET", kNotifySocket, 1);
  Child ingest([&] { ingest_life(vehicle, shared); });
  Child fusion([&] { fusion_life(vehicle, shared); });
  ::unsetenv("NOTIFY_SOCKET");
  graph.play_through("max");
  CHECK(shared.sweeps == kWarmUp + kSweeps);
  CHECK(shared.ingest.allocations == 0);
  CHECK(shared.fusion.allocations == 0);
  CHECK(shared.ingest_faults <= kMostFaults);
  CHECK(shared.fusion_faults <= kMostFaults);
  ingest.send(SIGTERM);
  fusion.send(SIGTERM);
  CHECK(ingest.wait() == 0);
  CHECK(fusion.wait() == 0);
  graph.stop();
}
