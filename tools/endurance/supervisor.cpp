#include "tools/endurance/supervisor.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>

#include "ipc/runtime.hpp"

namespace gvom::endurance {

namespace {

constexpr std::int64_t kRestartPause_ns = 100'000'000;
constexpr std::int64_t kStopPatience_ns = 5'000'000'000;

[[noreturn]] void become(const std::string& path, const std::vector<std::string>& arguments,
                         const std::string& folder, const std::string& log) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::setsid();  // a Ctrl-C is for the soak alone
  const int output = ::open(log.c_str(), O_CREAT | O_APPEND | O_WRONLY, 0644);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  ::close_range(STDERR_FILENO + 1, ~0U, 0);
  std::vector<const char*> argv{path.c_str()};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  argv.push_back(nullptr);
  if (::chdir(folder.c_str()) == 0) ::execv(path.c_str(), const_cast<char* const*>(argv.data()));
  ::_exit(127);
}

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

bool is_final(int code) {
  return code == 64 || code == 65 || code == 78 || code == 127;
}

}  // namespace

Supervisor::Supervisor(const Place& place, const std::vector<std::string>& arguments,
                       const std::vector<std::string>& lidars)
    : place_(place) {
  processes_.push_back({"gvom-roudi", "gvom-roudi", arguments});
  processes_.push_back({"gvom-fusion", "gvom-fusion", arguments});
  for (const std::string& lidar : lidars)
    processes_.push_back({"gvom-ingest-" + lidar, "gvom-ingest", joined(arguments, {"--lidar", lidar})});
  processes_.push_back({"gvom-odometry", "gvom-odometry", joined(arguments, {"--loop"})});
}

Supervisor::~Supervisor() {
  end_all();
}

void Supervisor::step() {
  Process& broker = processes_.front();
  if (reap(broker)) {
    end_all();
    for (Process& process : processes_) process.next_start_ns = ipc::monotonic_ns() + kRestartPause_ns;
  }
  for (Process& process : processes_) {
    reap(process);
    const bool has_broker = &process == &broker || (broker.pid >= 0 && ipc::broker_answers());
    if (process.pid < 0 && has_broker && ipc::monotonic_ns() >= process.next_start_ns) start(process);
  }
}

void Supervisor::kill(const std::string& name) {
  for (const Process& process : processes_)
    if (process.name == name && process.pid >= 0) ::kill(process.pid, SIGKILL);
}

void Supervisor::stop() {
  for (auto process = processes_.rbegin(); process != processes_.rend(); ++process) {
    if (process->pid < 0) continue;
    ::kill(process->pid, SIGTERM);
    const std::int64_t deadline_ns = ipc::monotonic_ns() + kStopPatience_ns;
    while (!reap(*process) && ipc::monotonic_ns() < deadline_ns)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (process->pid >= 0) end(*process);
  }
}

void Supervisor::start(Process& process) {
  process.pid = ::fork();
  if (process.pid == 0)
    become(place_.programs + "/" + process.program, process.arguments, place_.folder, log_of(process));
}

/// True if it has just ended.
bool Supervisor::reap(Process& process) {
  int status = 0;
  if (process.pid < 0 || ::waitpid(process.pid, &status, WNOHANG) != process.pid) return false;
  process.pid = -1;
  process.next_start_ns = ipc::monotonic_ns() + kRestartPause_ns;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  if (is_final(code))
    failure_ = process.name + " ended with exit code " + std::to_string(code) + ": see " + log_of(process);
  return true;
}

std::string Supervisor::log_of(const Process& process) const {
  return place_.logs + "/" + process.name + ".log";
}

void Supervisor::end_all() {
  for (Process& process : processes_)
    if (process.pid >= 0) end(process);
}

void Supervisor::end(Process& process) {
  ::kill(process.pid, SIGKILL);
  ::waitpid(process.pid, nullptr, 0);
  process.pid = -1;
}

}  // namespace gvom::endurance
