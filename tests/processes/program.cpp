#include "tests/processes/program.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <sstream>

#include "tests/ipc/processes.hpp"

namespace gvom::test {

using ipc::test::eventually;

namespace {

std::string next_log(const std::string& folder, const std::string& name) {
  static int count = 0;
  return folder + "/" + name + "." + std::to_string(++count) + ".log";
}

[[noreturn]] void become(const std::string& name, const std::vector<std::string>& arguments,
                         const std::string& folder, const std::string& log) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int output = ::open(log.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  const std::string path = std::string(GVOM_BIN) + "/" + name;
  std::vector<const char*> argv{name.c_str()};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  argv.push_back(nullptr);
  if (::chdir(folder.c_str()) == 0) ::execv(path.c_str(), const_cast<char* const*>(argv.data()));
  ::_exit(127);
}

}  // namespace

Program::Program(const std::string& name, const std::vector<std::string>& arguments, std::string folder)
    : log_(next_log(folder, name)), pid_(::fork()) {
  if (pid_ == 0) become(name, arguments, folder, log_);
}

Program::~Program() {
  if (!ended_) kill();
}

bool Program::reap(int flags) {
  int status = 0;
  if (ended_ || ::waitpid(pid_, &status, flags) != pid_) return ended_;
  ended_ = true;
  code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return true;
}

int Program::wait(std::chrono::milliseconds patience) {
  if (eventually([this] { return reap(WNOHANG); }, patience)) return code_;
  kill();
  return kHung;
}

int Program::stop(int signal) {
  send(signal);
  return wait();
}

void Program::send(int signal) const {
  if (!ended_) ::kill(pid_, signal);
}

int Program::kill() {
  send(SIGKILL);
  reap(0);
  return code_;
}

int Program::kill_asleep() {
  eventually([this] { return ipc::test::is_asleep(pid_); });
  return kill();
}

bool Program::runs() {
  return !reap(WNOHANG);
}

bool Program::says(const std::string& words, std::chrono::milliseconds patience) const {
  return eventually([&] { return output().find(words) != std::string::npos; }, patience);
}

std::string Program::output() const {
  std::ostringstream text;
  text << std::ifstream(log_).rdbuf();
  return text.str();
}

Ended run(const std::string& name, const std::vector<std::string>& arguments, const std::string& folder) {
  Program program(name, arguments, folder);
  const int code = program.wait();
  return {code, program.output()};
}

}  // namespace gvom::test
