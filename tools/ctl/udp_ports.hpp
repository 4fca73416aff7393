// Who has a UDP port.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gvom::ctl {

/// Inodes of the sockets that are bound to `port`, from the text of /proc/net/udp or udp6.
std::vector<std::uint64_t> sockets_on(const std::string& table, std::uint16_t port);

struct PortOwner {
  int pid;
  std::string command;  ///< Its command line, words separated by spaces.
};

/// A process that has the port on IPv4 or IPv6; nothing if none has, or it is another user's, whose files
/// only root may see.
std::optional<PortOwner> owner_of_port(std::uint16_t port);

}  // namespace gvom::ctl
