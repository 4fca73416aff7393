#include "tests/dds/peer_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gvom::dds::test {

Peer::Peer(const std::vector<std::string>& arguments, const std::string& program) {
  int in[2];
  int out[2];
  if (::pipe2(in, O_CLOEXEC) != 0 || ::pipe2(out, O_CLOEXEC) != 0) return;
  const std::string path = GVOM_DDS_PEERS "/" + program;
  std::vector<const char*> argv{program.c_str()};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  argv.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::dup2(in[0], STDIN_FILENO);
    ::dup2(out[1], STDOUT_FILENO);
    ::execv(path.c_str(), const_cast<char* const*>(argv.data()));
    ::_exit(127);
  }
  ::close(in[0]);
  ::close(out[1]);
  to_ = in[1];
  from_ = out[0];
}

Peer::~Peer() {
  send(SIGKILL);
  ::waitpid(pid_, nullptr, 0);
  ::close(to_);
  ::close(from_);
}

bool Peer::read_more(std::chrono::milliseconds patience) {
  pollfd wait{from_, POLLIN, 0};
  if (::poll(&wait, 1, static_cast<int>(patience.count())) != 1) return false;
  char buffer[4096];
  const ssize_t size = ::read(from_, buffer, sizeof buffer);
  if (size <= 0) return false;
  unread_.append(buffer, static_cast<std::size_t>(size));
  return true;
}

std::string Peer::line(const std::string& words, std::chrono::seconds patience) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + patience;
  for (;;) {
    for (std::size_t newline; (newline = unread_.find('\n')) != std::string::npos;) {
      const std::string said = unread_.substr(0, newline);
      unread_.erase(0, newline + 1);
      if (said.rfind(words, 0) == 0) return said;
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    if (left.count() <= 0 || !read_more(left)) return {};
  }
}

void Peer::go() const {
  if (::write(to_, "\n", 1) < 0) return;  // it is gone: its silence says so
}

void Peer::send(int signal) const {
  if (pid_ > 0) ::kill(pid_, signal);
}

}  // namespace gvom::dds::test
