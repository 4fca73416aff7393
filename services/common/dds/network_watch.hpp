// Whether the network that was joined is still there: Cyclone DDS does not look again.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace gvom::dds {

/// An IPv4 address of an interface that is up.
struct InterfaceAddress {
  std::string name;
  unsigned index = 0;  ///< The kernel's: an interface that was removed and comes again has another.
  std::string address;
  bool loopback = false;

  bool operator==(const InterfaceAddress& other) const {
    return name == other.name && index == other.index && address == other.address;
  }
};
using InterfaceAddresses = std::vector<InterfaceAddress>;

/// Those of this machine now.
InterfaceAddresses interface_addresses();

/// Those that a domain may use: of `interface`, a name or an address; without one all but the loopback's, or
/// those where there is nothing else (`or_loopback`).
InterfaceAddresses usable(const InterfaceAddresses& all, const std::string& interface,
                          bool or_loopback = true);

/// Whether there are some, all of the loopback.
bool is_loopback(const InterfaceAddresses& addresses);

/// Why who joined by `before` has to join anew; empty if not. Of a named interface each address counts;
/// without one it is not known which Cyclone took, so only the loss of all does, and the first network beside
/// the loopback. Nothing before: never.
std::string loss_between(const std::string& interface, const InterfaceAddresses& before,
                         const InterfaceAddresses& now);

/// For any thread.
class NetworkWatch {
 public:
  /// Remembers what `interface` is now; `or_loopback` as of usable.
  explicit NetworkWatch(std::string interface, bool or_loopback = true);

  /// As loss_between; looks at most once a second.
  [[nodiscard]] std::string loss();

 private:
  const std::string interface_;
  const InterfaceAddresses before_;
  std::mutex mutex_;  // of what follows
  std::int64_t next_look_ns_ = 0;
  std::string loss_;
};

}  // namespace gvom::dds
