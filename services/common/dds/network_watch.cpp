#include "services/common/dds/network_watch.hpp"

#include <algorithm>
#include <ctime>
#include <iterator>
#include <memory>
#include <utility>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

namespace gvom::dds {
namespace {

constexpr std::int64_t kLook_ns = 1'000'000'000;

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

std::string names_of(const InterfaceAddresses& addresses) {
  std::string names;
  for (const InterfaceAddress& one : addresses)
    names += (names.empty() ? "" : ", ") + one.address + " of " + one.name;
  return names;
}

}  // namespace

InterfaceAddresses interface_addresses() {
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(first, ::freeifaddrs);
  InterfaceAddresses found;
  for (const ifaddrs* one = first; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET || (one->ifa_flags & IFF_UP) == 0)
      continue;
    char text[INET_ADDRSTRLEN] = "";
    ::inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr, text, sizeof text);
    found.push_back(
        {one->ifa_name, ::if_nametoindex(one->ifa_name), text, (one->ifa_flags & IFF_LOOPBACK) != 0});
  }
  return found;
}

InterfaceAddresses usable(const InterfaceAddresses& all, const std::string& interface, bool or_loopback) {
  InterfaceAddresses found;
  std::copy_if(all.begin(), all.end(), std::back_inserter(found), [&](const InterfaceAddress& one) {
    return interface.empty() ? !one.loopback : one.name == interface || one.address == interface;
  });
  return interface.empty() && found.empty() && or_loopback ? all : found;
}

bool is_loopback(const InterfaceAddresses& addresses) {
  return !addresses.empty() && std::all_of(addresses.begin(), addresses.end(),
                                           [](const InterfaceAddress& one) { return one.loopback; });
}

std::string loss_between(const std::string& interface, const InterfaceAddresses& before,
                         const InterfaceAddresses& now) {
  InterfaceAddresses lost;
  std::copy_if(before.begin(), before.end(), std::back_inserter(lost), [&](const InterfaceAddress& one) {
    return std::find(now.begin(), now.end(), one) == now.end();
  });
  const InterfaceAddresses found = usable(now, interface);
  if (interface.empty() && is_loopback(before) && !found.empty() && !is_loopback(found))
    return "only the loopback was joined, and there is a network now: " + names_of(found);
  if (lost.empty() || (interface.empty() && lost.size() < before.size())) return {};
  return "the network that was joined is gone: " + names_of(lost);
}

NetworkWatch::NetworkWatch(std::string interface, bool or_loopback)
    : interface_(std::move(interface)), before_(usable(interface_addresses(), interface_, or_loopback)) {}

std::string NetworkWatch::loss() {
  const std::lock_guard lock(mutex_);
  if (now_ns() >= next_look_ns_) {
    next_look_ns_ = now_ns() + kLook_ns;
    loss_ = loss_between(interface_, before_, interface_addresses());
  }
  return loss_;
}

}  // namespace gvom::dds
