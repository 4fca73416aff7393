#include "tests/faults/lab.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <sstream>

#include "tests/faults/sensor.hpp"

namespace gvom::test {

using namespace std::chrono_literals;
using ipc::test::Child;
using ipc::test::eventually;

namespace {

constexpr const char* kReaders[] = {"gvom-ingest-front", "gvom-ingest-rear", "gvom-fusion"};

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// What a process counted as dropped from one Health to another.
std::string dropped_between(const ipc::Health& before, const ipc::Health& after) {
  std::string text;
  for (std::uint32_t i = 0; i < after.counter_count; ++i) {
    const std::uint64_t more = after.counters[i].value - before.counters[i].value;
    if (std::strncmp(after.counters[i].name, "drop_", 5) == 0 && more > 0)
      text += (text.empty() ? "" : ", ") + std::string(after.counters[i].name) + " " + std::to_string(more);
  }
  return text;
}

Board* shared_board() {
  void* memory = ::mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  return new (memory) Board;
}

}  // namespace

Vehicle Lab::make_vehicle(const std::vector<std::string>& sets) {
  write_text(folder.path() + "/meta.json", looking_down().json());
  Vehicle vehicle{folder.path() + "/lab.yaml", {"front", "rear"}, folder.path(), small_map()};
  std::ofstream file(vehicle.file);
  file << "name: lab\nodometry: {timeout_s: 5, max_clock_offset_s: 3, max_speed_mps: 1}\nfusion: "
          "{voxel_rate_hz: 50}\nlidars:\n";
  for (const auto& [name, port, yaw] :
       {std::tuple("front", front_port_, 0.0), std::tuple("rear", rear_port_, 3.0)}) {
    file << "  " << name << ":\n    source: 'ouster-udp:" << port << "?meta=meta.json'\n"
         << "    max_returns: 2048\n    T_base_sensor: {x: 0, y: 0, z: 2, roll: 0, pitch: 0, yaw: " << yaw
         << "}\n";
  }
  vehicle.sets.insert(vehicle.sets.end(), sets.begin(), sets.end());
  return vehicle;
}

Lab::Lab(const std::vector<std::string>& sets)
    : board(shared_board()), front_port_(free_port()), rear_port_(free_port()) {
  graph = std::make_unique<Graph>(make_vehicle(sets));
  observer = std::make_unique<Observer>(folder.path());
  REQUIRE(observer->is_up());
  graph->start_readers();
  for (const char* process : kReaders)
    REQUIRE(eventually([&] { return observer->health(process).has_value(); }));  // it listens
  board->begin_ns = ipc::monotonic_ns();
  odometry_ = std::make_unique<Child>([this] { live_as_odometry(*board); });
  REQUIRE(eventually([this] { return board->has_pose.load(); }));  // no sweep is of before it
  front_ = std::make_unique<Child>(
      [this] { live_as_sensor(front_port_, board->front, board->front_ahead_ns, *board); });
  rear_ = std::make_unique<Child>([this] { live_as_sensor(rear_port_, board->rear, 0, *board); });
  judge_ = std::make_unique<Child>([this] { live_as_judge(*board); });
  for (const char* process : kReaders) {
    const bool well = eventually([&] { return is_ok(process); });
    INFO(process << ": " << reason(process));
    REQUIRE(well);
  }
  REQUIRE(eventually([this] { return board->maps > 0; }));
}

std::string Lab::reason(const std::string& process) const {
  const auto health = observer->health(process);
  return health ? health->reason : "(nothing)";
}

bool Lab::is_ok(const std::string& process) const {
  const auto health = observer->health(process);
  return health && health->state == static_cast<std::uint32_t>(ipc::HealthState::ok);
}

bool Lab::layers_flow(std::uint64_t more) const {
  const std::uint64_t before = observer->layers();
  return eventually([&] { return observer->layers() >= before + more; });
}

std::string Lab::drops_besides(const std::string& process, const std::string& late) const {
  std::istringstream drops(observer->drops(process));
  std::string others;
  for (std::string drop; drops >> drop;)
    if (drop.rfind(late + "=", 0) != 0) others += drop + " ";
  return others;
}

std::int64_t Lab::drive_ns() const {
  return ipc::monotonic_ns() - board->begin_ns;
}

void Lab::check_fault(const std::string& fault, const std::string& process, const std::string& words,
                      const std::function<void()>& break_it, const std::function<void()>& cure_it) {
  INFO(fault);
  const std::uint64_t mapped = observer->counter("gvom-ingest-rear", "sweeps_mapped");
  const auto before = observer->health(process);
  REQUIRE(before);
  const bool is_old_news = observer->has_said(process, words);
  break_it();
  const auto broken = std::chrono::steady_clock::now();
  std::string told;
  const bool said = eventually([&] {
    told = reason(process);
    if (!is_old_news && observer->has_said(process, words)) return true;  // some it tells for a second only
    return !is_ok(process) && told.find(words) != std::string::npos;
  });
  const double said_after_s = seconds_since(broken);
  std::this_thread::sleep_for(1100ms);  // the next Health, with the numbers of a whole second
  if (!is_ok(process)) told = reason(process);
  cure_it();
  const auto cured = std::chrono::steady_clock::now();
  CHECK(eventually([&] { return is_ok(process); }));
  const double recovery_s = seconds_since(cured);
  INFO("said: " << told);
  CHECK(said);
  CHECK(eventually([&] { return observer->counter("gvom-ingest-rear", "sweeps_mapped") > mapped; }));
  const auto judged = board->maps.load();
  CHECK(eventually([&] { return board->maps > judged; }));  // who judges them lives
  char seen[256];
  std::snprintf(seen, sizeof seen, "Health after %.2f s: \"%s\"", said_after_s, told.c_str());
  report(fault, seen, recovery_s, dropped_between(*before, *observer->health(process)));
}

void Lab::stop() {
  judge_.reset();
  front_.reset();
  rear_.reset();
  odometry_.reset();
  graph->stop();
}

void report(const std::string& fault, const std::string& seen, double recovery_s, const std::string& lost) {
  std::printf("FAULT | %s | %s | %.2f s | %s |\n", fault.c_str(), seen.c_str(), recovery_s,
              lost.empty() ? "nothing" : lost.c_str());
  std::fflush(stdout);
}

int repeats(int few) {
  const char* set = std::getenv("GVOM_FAULTS_REPEAT");
  return set != nullptr ? std::max(1, std::atoi(set)) : few;
}

std::uint64_t resident_bytes(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/status");
  std::string line;
  while (std::getline(file, line))
    if (line.compare(0, 8, "RssAnon:") == 0) return std::stoull(line.substr(8)) * 1024;
  return 0;
}

int descriptors(pid_t pid) {
  const std::filesystem::directory_iterator entries("/proc/" + std::to_string(pid) + "/fd");
  return static_cast<int>(std::distance(begin(entries), end(entries)));
}

}  // namespace gvom::test
