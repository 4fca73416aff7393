// gvom-test-kills LIDAR,LIDAR... PROCESS,PROCESS... ROUNDS [SECONDS]: kills those processes at random
// moments, in turn, so often each, and holds everything else to what it must do meanwhile; with SECONDS it
// stops them for so long instead (SIGSTOP). Joins the bus, so it runs as the user of the services, which live
// under a supervisor. A line for each kill. Exit codes: 0 all was well, 1 not so, 75 the broker went away in
// between (to be called again). The bounds on times are those that tools/faults holds the graph to
// (GVOM_FAULTS_REPEAT is set); without, as among other tests on a busy machine, they are ten times as long,
// and a lidar next to a faulted one need not keep all its maps.
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <sstream>
#include <thread>

#include "tests/systemd/bus_log.hpp"

namespace {

using namespace gvom;
using namespace std::chrono_literals;
using test::BusLog;

constexpr std::uint32_t kFull = 8;                     // maps of each lidar: window.buffer_size
constexpr std::int64_t kPatience_ns = 60'000'000'000;  // for what has no bound of its own
constexpr double kWindowWithin_s = 1.5;
constexpr double kNamedWithin_s = 0.5;
constexpr double kOthersPause_s = 1;
constexpr std::uint32_t kStrayChunks = 2;  // in flight at the moment of a report
constexpr int kReports = 2;

struct Task {
  std::vector<std::string> lidars;
  std::vector<std::string> processes;
  int rounds = 0;
  double stop_s = 0;
};

/// A process that is killed, or stopped for a while. Times: CLOCK_MONOTONIC, ns.
struct Fault {
  std::string process;
  std::int64_t begin_ns = 0;
  std::int64_t cure_ns = 0;  ///< From here on it can be well again.

  [[nodiscard]] bool concerns(const std::string& lidar) const { return process == "gvom-ingest-" + lidar; }
};

double seconds(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-9;
}

bool is_strict() {
  static const bool strict = std::getenv("GVOM_FAULTS_REPEAT") != nullptr;
  return strict;
}

bool is_within(std::int64_t took_ns, double bound_s) {
  return seconds(took_ns) < (is_strict() ? bound_s : 10 * bound_s);
}

class Campaign {
 public:
  Campaign(Task task, ipc::Runtime& runtime, BusLog log)
      : task_(std::move(task)), runtime_(runtime), log_(std::move(log)) {}

  bool run() {
    const std::size_t kills = task_.stop_s > 0 ? 0 : task_.rounds * task_.processes.size();
    const bool can_tell = kills > kStrayChunks;                       // a chunk lost with each
    wait("all is well at first", [&] { return all_well_since(0); });  // the window is full, too
    const auto before = can_tell ? pools() : std::vector<std::uint32_t>{};
    for (int round = 0; round < task_.rounds; ++round)
      for (const std::string& process : task_.processes) play(process);
    auto after = before;
    for (int tries = 0; can_tell && (tries == 0 || (tries < 10 && !is_back(after, before))); ++tries)
      after = pools();
    for (std::size_t i = 0; i < before.size(); ++i)
      std::printf("pool %zu: %u chunks in use, %u before\n", i, after[i], before[i]);
    check(is_back(after, before), "chunks are lost");  // what is in flight on a busy machine comes back
    return failures_ == 0;
  }

 private:
  using Condition = std::function<bool()>;

  /// Until the condition holds. A wait that ends otherwise is the end of the campaign.
  void wait(const char* what, const Condition& condition) {
    const std::int64_t deadline_ns = ipc::monotonic_ns() + kPatience_ns;
    while (!condition()) {
      log_.pump();
      if (!runtime_.broker_alive()) {
        std::printf("%s: the broker hung, %.2f s after it\n", last_.process.c_str(),
                    seconds(ipc::monotonic_ns() - last_.begin_ns));
        leave(75);
      }
      if (ipc::monotonic_ns() < deadline_ns) continue;
      std::printf("NOT WELL: in vain for 60 s: %s\n", what);
      leave(1);
    }
  }

  [[noreturn]] static void leave(int code) {
    std::fflush(stdout);
    ::_exit(code);
  }

  template <class... Values>
  void check(bool good, const char* format, Values... values) {
    if (good) return;
    ++failures_;
    std::printf("; NOT WELL: ");
    std::printf(format, values...);
  }

  std::vector<std::uint32_t> pools() {
    log_.pool_reports = 0;
    wait("reports of the pools", [&] { return log_.pool_reports >= kReports; });
    return log_.used_chunks;
  }

  static bool is_back(const std::vector<std::uint32_t>& used, const std::vector<std::uint32_t>& before) {
    return std::equal(used.begin(), used.end(), before.begin(), before.end(),
                      [](std::uint32_t now, std::uint32_t then) { return now <= then + kStrayChunks; });
  }

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names = task_.processes;
    const auto add = [&](const std::string& name) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    };
    add("gvom-fusion");
    for (const std::string& lidar : task_.lidars) add("gvom-ingest-" + lidar);
    return names;
  }

  [[nodiscard]] bool all_well_since(std::int64_t since_ns) const {
    for (const std::string& name : names()) {
      const auto process = log_.processes.find(name);
      if (process == log_.processes.end() || process->second.heard_ns < since_ns || !process->second.ok)
        return false;
    }
    return log_.is_full(kFull);
  }

  /// The victim works again: what it makes came since, and the window is full.
  [[nodiscard]] bool is_back(const Fault& fault, std::uint64_t old_epoch) const {
    if (!log_.is_full(kFull) || log_.newest.mono_published_ns < fault.cure_ns) return false;
    for (const BusLog::Lidar& lidar : log_.lidars) {
      if (fault.concerns(lidar.name) && lidar.maps.newest_ns < fault.cure_ns) return false;
    }
    return fault.process != "gvom-odometry" || task_.stop_s > 0 || log_.newest.header.epoch > old_epoch;
  }

  void play(const std::string& process) {
    wait("all is well before a fault", [&] { return all_well_since(0); });
    const auto before = log_.processes;
    const std::uint64_t epoch = log_.newest.header.epoch;
    log_.begin_anew();
    const Fault fault = last_ = strike(process, before.at(process).pid);
    wait("it is back with a full window", [&] { return is_back(fault, epoch); });
    const std::int64_t back_ns = ipc::monotonic_ns();
    std::printf("%s: well again after %.2f s", process.c_str(), seconds(back_ns - fault.cure_ns));
    for (const BusLog::Lidar& lidar : log_.lidars) {
      if (fault.concerns(lidar.name)) {
        judge_victim(lidar, fault);
      } else if (process != "gvom-odometry") {  // without it no sweep is mapped
        judge_other(lidar, back_ns);
      }
    }
    std::printf("\n");
    check(process != "gvom-fusion" || task_.stop_s > 0 || is_within(back_ns - fault.cure_ns, kWindowWithin_s),
          "that is too slow");
    wait("all are heard again", [&] { return all_well_since(back_ns); });
    check_pids(process, before);
    std::fflush(stdout);
  }

  Fault strike(const std::string& process, pid_t pid) {
    // Asleep, not woken by what the victim publishes: the moment would be that of a publish.
    std::this_thread::sleep_for(std::chrono::microseconds(moment_us_(random_)));
    const std::int64_t begin_ns = ipc::monotonic_ns();
    if (task_.stop_s <= 0) {
      ::kill(pid, SIGKILL);
      return {process, begin_ns, begin_ns};
    }
    ::kill(pid, SIGSTOP);
    const std::int64_t end_ns = begin_ns + static_cast<std::int64_t>(task_.stop_s * 1e9);
    wait("the end of the stop", [&] { return ipc::monotonic_ns() >= end_ns; });
    ::kill(pid, SIGCONT);
    return {process, begin_ns, ipc::monotonic_ns()};
  }

  void judge_other(const BusLog::Lidar& other, std::int64_t now_ns) {
    const std::int64_t gap_ns = other.maps.gap_ns(now_ns);
    std::printf(", %s paused %.2f s", other.name.c_str(), seconds(gap_ns));
    check(is_within(gap_ns, kOthersPause_s), "%s stood still", other.name.c_str());
  }

  /// A lidar's death: it is named as missing in time, or was back before that; the others keep their share.
  void judge_victim(const BusLog::Lidar& victim, const Fault& fault) {
    if (victim.named_missing_ns != 0) {
      const std::int64_t named_ns = victim.named_missing_ns - fault.begin_ns;
      std::printf(", named after %.2f s", seconds(named_ns));
      check(is_within(named_ns, kNamedWithin_s), "that is too late");
    } else {
      check(is_within(victim.maps.longest_gap_ns, kNamedWithin_s), "%s was never named", victim.name.c_str());
    }
    const std::int64_t gap_ns = log_.layers.longest_gap_ns;
    check(is_within(gap_ns, kOthersPause_s), "no layers for %.2f s", seconds(gap_ns));
    for (const BusLog::Lidar& other : log_.lidars) {
      if (other.name == victim.name) continue;
      const bool kept_all = other.fewest_maps >= kFull && other.named_missing_ns == 0;
      check(is_strict() ? kept_all : other.fewest_maps > 0, "%s was left with %u maps in the window",
            other.name.c_str(), other.fewest_maps);
    }
  }

  void check_pids(const std::string& victim, const std::map<std::string, BusLog::Process>& before) {
    for (const std::string& name : names()) {
      const bool is_new = log_.processes.at(name).pid != before.at(name).pid;
      if (name != victim) check(!is_new, "%s was started anew", name.c_str());
      if (name == victim && task_.stop_s <= 0) check(is_new, "%s did not die", name.c_str());
    }
  }

  Task task_;
  ipc::Runtime& runtime_;
  BusLog log_;
  std::mt19937 random_{std::random_device{}()};
  std::uniform_int_distribution<int> moment_us_{100'000, 400'000};
  Fault last_;
  int failures_ = 0;
};

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4 || argc > 5 || std::atoi(argv[3]) < 1) return 64;
  const Task task{split(argv[1]), split(argv[2]), std::atoi(argv[3]), argc > 4 ? std::atof(argv[4]) : 0};
  auto runtime = ipc::Runtime::connect("gvom-test-kills", 5s);
  if (!runtime) {
    std::fprintf(stderr, "%s\n", runtime.error().message.c_str());
    return 75;
  }
  auto log = BusLog::open(*runtime, task.lidars);
  if (!log) {
    std::fprintf(stderr, "%s\n", log.error().message.c_str());
    return 1;
  }
  const bool well = Campaign(task, *runtime, std::move(*log)).run();
  std::fflush(stdout);
  ::_exit(well ? 0 : 1);
}
