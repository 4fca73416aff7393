// A Fast DDS peer as a child (peer.cpp, robot.cpp), and what it says.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <sys/types.h>

namespace gvom::dds::test {

class Peer {
 public:
  /// `arguments`: the domain, the mode and what it wants. It dies with the test.
  explicit Peer(const std::vector<std::string>& arguments, const std::string& program = "dds_peer");
  ~Peer();
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// Reads what it says up to a line that begins with `words`, and returns that line; empty if none comes
  /// within the patience. Lines before it are gone.
  std::string line(const std::string& words, std::chrono::seconds patience = std::chrono::seconds(20));

  void go() const;  ///< Makes a sender send one.
  void send(int signal) const;

 private:
  bool read_more(std::chrono::milliseconds patience);

  pid_t pid_ = -1;
  int to_ = -1;
  int from_ = -1;
  std::string unread_;
};

}  // namespace gvom::dds::test
