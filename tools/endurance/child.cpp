#include "tools/endurance/child.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>

namespace gvom::endurance {

Child::Child(const std::function<int(int socket)>& live) {
  int sockets[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, sockets) != 0) return;
  std::fflush(nullptr);  // or the child prints it again
  pid_ = ::fork();
  if (pid_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::setsid();
    ::dup2(sockets[1], STDERR_FILENO + 1);
    ::close_range(STDERR_FILENO + 2, ~0U, 0);
    ::_exit(live(STDERR_FILENO + 1));
  }
  ::close(sockets[1]);
  socket_ = sockets[0];
}

Child::~Child() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  if (socket_ >= 0) ::close(socket_);
}

}  // namespace gvom::endurance
