// A process of our own that sends us notes, started again by whoever wants it to.
#pragma once

#include <sys/types.h>

#include <functional>

namespace gvom::endurance {

class Child {
 public:
  /// Forks; `live` gets its end of the channel and returns the code to exit with. It dies with us.
  explicit Child(const std::function<int(int socket)>& live);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] int socket() const { return socket_; }

 private:
  pid_t pid_ = -1;
  int socket_ = -1;
};

}  // namespace gvom::endurance
