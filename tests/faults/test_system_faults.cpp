// What lies below the processes: stopped processes, a wall clock that is set, shared memory that is full,
// leftovers of the dead.
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

#include "tests/faults/lab.hpp"

using namespace gvom::test;
using gvom::ipc::test::eventually;
using namespace std::chrono_literals;

namespace {

constexpr int kUnavailable = 69;

std::chrono::milliseconds pause() {
  return repeats(0) > 0 ? 5s : 2s;
}

/// Stops a process for a while; the test fails if not everybody then goes on.
void check_stopped(Lab& lab, const std::string& name, Program& program) {
  INFO(name);
  const auto lost_before = lab.observer->counter("gvom-fusion", "maps_lost");
  program.send(SIGSTOP);
  std::this_thread::sleep_for(pause());
  const auto stamp_ns = lab.observer->newest_layers().header.stamp_ns;
  const double age_s = static_cast<double>(lab.drive_ns() + 1'000'000'000'000 - stamp_ns) * 1e-9;
  program.send(SIGCONT);
  const auto begin = std::chrono::steady_clock::now();
  CHECK(eventually([&] {
    return lab.observer->newest_layers().header.stamp_ns > lab.drive_ns() + 1'000'000'000'000 - 500'000'000 &&
           lab.observer->newest_layers().lidars[0].missing == 0;
  }));
  const std::chrono::duration<double> recovery = std::chrono::steady_clock::now() - begin;
  CHECK(program.runs());
  for (const char* process : {"gvom-ingest-front", "gvom-ingest-rear", "gvom-fusion"})
    CHECK(eventually([&] { return lab.is_ok(process); }));
  const auto lost = lab.observer->counter("gvom-fusion", "maps_lost") - lost_before;
  char seen[96];
  std::snprintf(seen, sizeof seen, "layers at its end %.1f s old", age_s);
  report(name + " stopped for " + std::to_string(pause().count() / 1000) + " s", seen, recovery.count(),
         lost == 0 ? "" : std::to_string(lost) + " maps");
}

/// A step of this process's children's wall clock, seconds.
class WallClock {
 public:
  explicit WallClock(const std::string& path) : file_(path, std::ios::binary | std::ios::trunc) {
    set(0);
    ::setenv("GVOM_CLOCK_STEP", path.c_str(), 1);
    ::setenv("LD_PRELOAD", GVOM_CLOCK_STEP_LIBRARY, 1);
  }
  ~WallClock() { forget(); }
  static void forget() { ::unsetenv("LD_PRELOAD"); }
  void set(std::int64_t ahead_s) {
    file_.seekp(0).write(reinterpret_cast<const char*>(&ahead_s), sizeof ahead_s).flush();
  }

 private:
  std::ofstream file_;
};

/// True when the process told its health again.
bool goes_on(const Lab& lab, const std::string& process) {
  const auto before = lab.observer->health(process);
  return before && eventually([&] { return lab.observer->health(process)->mono_ns > before->mono_ns; });
}

}  // namespace

TEST_CASE("every process survives being stopped, and so do the others") {
  Lab lab;
  check_stopped(lab, "gvom-roudi", lab.graph->roudi());
  check_stopped(lab, "gvom-fusion", lab.graph->fusion());
  check_stopped(lab, "gvom-ingest", lab.graph->ingest("front"));
  CHECK(lab.board->wrong_maps == 0);
  lab.stop();
}

TEST_CASE("a lidar whose ingest is killed is missing, the other goes on, and it comes back") {
  Lab lab;
  const auto missing = [&](int lidar) { return lab.observer->newest_layers().lidars[lidar].missing == 1; };
  for (int round = 0; round < repeats(2); ++round) {
    CHECK(lab.graph->ingest("front").kill_asleep() == 128 + SIGKILL);
    const auto killed = std::chrono::steady_clock::now();
    CHECK(eventually([&] { return missing(0); }));
    const std::chrono::duration<double> named = std::chrono::steady_clock::now() - killed;
    CHECK(eventually([&] { return !missing(1); }));
    const auto started = std::chrono::steady_clock::now();
    lab.graph->start_ingest("front");
    CHECK(eventually([&] { return !missing(0); }));
    const std::chrono::duration<double> recovery = std::chrono::steady_clock::now() - started;
    char seen[64];
    std::snprintf(seen, sizeof seen, "Layers name it as missing after %.2f s", named.count());
    report("kill -9 of an ingest", seen, recovery.count(), "its sweeps meanwhile");
  }
  CHECK(lab.drops_besides("gvom-fusion", "drop_map_too_old") == "");
  lab.stop();
}

TEST_CASE("a wall clock that is set forward or back holds up nobody, not even who waits for nothing") {
  const TemporaryFolder folder;
  WallClock clock(folder.path() + "/step");
  Lab lab;
  WallClock::forget();
  for (const std::int64_t ahead_s : {3600, -3600, 0}) {
    INFO("the clock is now " << ahead_s << " s ahead");
    lab.board->front = lab.board->rear = SensorMode::silent;
    lab.board->odometry = OdometryMode::silent;
    std::this_thread::sleep_for(300ms);  // all wait
    clock.set(ahead_s);
    const auto begin = std::chrono::steady_clock::now();
    for (const char* process : {"gvom-ingest-front", "gvom-ingest-rear", "gvom-fusion"}) {
      INFO(process);
      CHECK(goes_on(lab, process));
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    lab.board->odometry = OdometryMode::well;
    lab.board->front = lab.board->rear = SensorMode::well;
    CHECK(lab.layers_flow());
    report("wall clock set to " + std::to_string(ahead_s) + " s ahead", "nothing", took.count(), "");
  }
  lab.stop();
}

TEST_CASE("shared memory that is full at the start is said, with 69; so it is when others fill it") {
  REQUIRE(::mount("tmpfs", "/dev/shm", "tmpfs", 0, "size=8m") == 0);
  const TemporaryFolder folder;
  const Vehicle vehicle{GVOM_SOURCE_DIR "/config/vehicles/two_lidars.yaml", {}, folder.path(), small_map()};
  const Ended small = run("gvom-roudi", vehicle.arguments(), folder.path());
  INFO(small.output);
  CHECK(small.code == kUnavailable);
  CHECK_THAT(small.output, Catch::Contains("bytes in /dev/shm") && Catch::Contains("enlarge it"));
  report("/dev/shm too small at start",
         "gvom-roudi ends with 69: the pools need so many bytes, so many are there", 0, "");

  REQUIRE(::mount("tmpfs", "/dev/shm", "tmpfs", MS_REMOUNT, "size=512m") == 0);
  std::ofstream others("/dev/shm/others", std::ios::binary);
  const std::vector<char> megabyte(1 << 20);
  for (int i = 0; i < 400; ++i) others.write(megabyte.data(), 1 << 20);
  others.flush();
  const Ended full = run("gvom-roudi", vehicle.arguments(), folder.path());
  INFO(full.output);
  CHECK(full.code == kUnavailable);
  CHECK_THAT(full.output, Catch::Contains("bytes in /dev/shm"));
  others.close();
  ::umount("/dev/shm");
}

TEST_CASE("after kill -9 of everything a fresh start finds its way through what they left") {
  for (int round = 0; round < repeats(1); ++round) {
    {
      Lab lab;
      lab.graph->ingest("rear").kill();
      lab.graph->ingest("front").kill();
      lab.graph->fusion().kill();
      lab.graph->roudi().kill();
    }
    const auto begin = std::chrono::steady_clock::now();
    Lab again;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    report("kill -9 of everything", "layers stop", took.count(), "the window");
    again.stop();
  }
}

TEST_CASE("a lock of another user is named, and not waited for") {
  Lab lab;
  CHECK(lab.graph->fusion().stop() == 0);
  std::ofstream("/tmp/gvom-fusion.lock").put(' ');
  if (::chmod("/tmp/gvom-fusion.lock", 0600) != 0 || ::chown("/tmp/gvom-fusion.lock", 1, 1) != 0) {
    WARN("SKIPPED: this user cannot give files away");
    return;
  }
  const Ended ended = run("gvom-fusion", lab.graph->vehicle().arguments(), lab.folder.path());
  INFO(ended.output);
  CHECK(ended.code == kUnavailable);
  CHECK_THAT(ended.output, Catch::Contains("/tmp/gvom-fusion.lock"));
  ::unlink("/tmp/gvom-fusion.lock");
  lab.graph->start_fusion();
  CHECK(lab.layers_flow());
  report("a lock of another user", "gvom-fusion ends with 69 and names the file", 0, "");
  lab.stop();
}
