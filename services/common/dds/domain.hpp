// How Cyclone DDS is configured: by us, not by the environment.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace gvom::dds {

inline constexpr int kLastDomain = 232;                                // beyond it there are no ports
inline constexpr std::size_t kLargestMessage = std::size_t{64} << 20;  // bytes, in and out

/// Which network, and who is on it.
struct DomainOptions {
  int id = 0;                      ///< ROS_DOMAIN_ID, 0 .. 232.
  std::string interface;           ///< "eth0", or an address of it; empty: what Cyclone finds.
  std::vector<std::string> peers;  ///< Names or addresses of machines that multicast does not reach.
  std::string config_file;         ///< More of Cyclone's XML, which comes after ours; empty: none.
};

/// Cyclone's configuration as XML: no shared memory (it would want a broker, and end the process without
/// one), sockets' buffers as large as the kernel gives, large datagrams. Errors: a domain, interface or peer
/// that cannot be one, a file that is not there, is over 1 MiB, is no XML or speaks of SharedMemory.
tl::expected<std::string, std::string> domain_xml(const DomainOptions& options);

}  // namespace gvom::dds
