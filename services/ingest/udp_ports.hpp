// Who has a UDP port.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gvom::ingest {

/// Inodes of the sockets that are bound to `port`, from the text of /proc/net/udp or udp6.
std::vector<std::uint64_t> sockets_on(const std::string& table, std::uint16_t port);

struct PortHolder {
  int pid;
  std::string command;  ///< Its command line, words separated by spaces.
};

/// A process that has the port on IPv4 or IPv6; nothing if none has, or it is another user's, whose files
/// only root may see.
std::optional<PortHolder> owner_of_port(std::uint16_t port);

/// "gvom-ingest ... --lidar NAME ...", by whatever path.
bool is_ingest_of(const PortHolder& owner, const std::string& lidar);

/// The port of a live source; nothing if `source` is none.
std::optional<std::uint16_t> live_port(const std::string& source);

}  // namespace gvom::ingest
