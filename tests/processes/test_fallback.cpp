// `backend: auto` on a device that fails whenever it is used: the fourth start within a minute is on the CPU.
#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>

#include "ipc/text.hpp"
#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom::test;
using Catch::Contains;
using gvom::ipc::HealthState;
using gvom::ipc::test::eventually;

namespace {

constexpr int kTryAgain = 75;
constexpr char kWhy[] = "the GPU failed 3 times within a minute, so the CPU computes until a later start: ";

/// A replay for fusion and the front lidar's ingest, on a device that is lost soon after it was opened.
class FailingDevice {
 public:
  FailingDevice() : graph_(recorded(folder_.path())), observer_(folder_.path()) {
    REQUIRE(observer_.is_up());
    for (const char* process : {"gvom-fusion", "gvom-ingest-front"})
      std::filesystem::remove(std::string("/tmp/") + process + ".device-failures");
    ::setenv(kFailAt, "400", 1);  // past the first sweeps and ticks
    odometry_ = graph_.replay({"--rate", "1", "--loop"});
  }
  ~FailingDevice() { ::unsetenv(kFailAt); }
  FailingDevice(const FailingDevice&) = delete;
  FailingDevice& operator=(const FailingDevice&) = delete;

  [[nodiscard]] std::unique_ptr<Program> fusion(const std::string& backend) const {
    return graph_.start("gvom-fusion-serial", {"--set", "fusion.backend=" + backend});
  }
  [[nodiscard]] std::unique_ptr<Program> ingest(const std::string& backend) const {
    return graph_.start("gvom-ingest-serial",
                        {"--lidar", "front", "--set", "lidars.front.backend=" + backend});
  }
  [[nodiscard]] const Observer& observer() const { return observer_; }

  void stop(Program& fusion, Program& ingest) {
    CHECK(odometry_->stop() == 0);
    CHECK(ingest.stop() == 0);
    CHECK(fusion.stop() == 0);
    CHECK(graph_.roudi().stop() == 0);
  }

 private:
  static constexpr const char* kFailAt = "GVOM_SERIAL_DEVICE_FAIL_AT";

  static Vehicle recorded(const std::string& folder) {
    simulated(folder, 2);
    return front_only(folder);
  }

  TemporaryFolder folder_;
  Graph graph_;
  Observer observer_;
  std::unique_ptr<Program> odometry_;
};

void check_fails_in_flight(const std::unique_ptr<Program>& program) {
  const int code = program->wait();
  INFO(program->output());
  CHECK(code == kTryAgain);
  CHECK_THAT(program->output(), Contains(" on cuda: ") && Contains(": leaving, to be started again"));
}

void check_runs_on_cpu(const Observer& observer, const std::string& process, const Program& program) {
  CHECK(eventually([&] { return observer.backend(process).find(std::string("cpu: ") + kWhy) == 0; }));
  const auto says_why = [&] {
    const auto health = observer.health(process);
    return health->state == static_cast<std::uint32_t>(HealthState::degraded) &&
           gvom::ipc::text_of(health->reason).find(kWhy) == 0;
  };
  const bool said = eventually(says_why);
  INFO(program.output());
  CHECK(said);
  CHECK_THAT(program.output(), Contains(std::string("warning: ") + kWhy));
}

}  // namespace

TEST_CASE("fusion on auto whose device failed three times goes on with the CPU and says why; cuda does not") {
  FailingDevice device;
  const auto ingest = device.ingest("cpu");
  for (int start = 1; start <= 3; ++start) check_fails_in_flight(device.fusion("auto"));
  const auto before = device.observer().layers();
  auto fusion = device.fusion("auto");
  check_runs_on_cpu(device.observer(), "gvom-fusion", *fusion);
  CHECK(eventually([&] { return device.observer().layers() > before + 10; }));
  CHECK(fusion->stop() == 0);

  check_fails_in_flight(device.fusion("cuda"));
  fusion = device.fusion("auto");
  check_runs_on_cpu(device.observer(), "gvom-fusion", *fusion);
  device.stop(*fusion, *ingest);
}

TEST_CASE("an ingest on auto has a record of its own") {
  FailingDevice device;
  auto fusion = device.fusion("cpu");
  for (int start = 1; start <= 3; ++start) check_fails_in_flight(device.ingest("auto"));
  const auto ingest = device.ingest("auto");
  check_runs_on_cpu(device.observer(), "gvom-ingest-front", *ingest);

  CHECK(fusion->stop() == 0);
  check_fails_in_flight(device.fusion("auto"));
  fusion = device.fusion("cpu");
  const auto before = device.observer().layers();
  CHECK(eventually([&] { return device.observer().layers() > before; }));
  device.stop(*fusion, *ingest);
}
