#include "services/common/dds/domain.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>

#include <arpa/inet.h>

namespace gvom::dds {
namespace {

using Failed = tl::unexpected<std::string>;

constexpr std::size_t kLargestFile = std::size_t{1} << 20;
constexpr std::size_t kLongestHost = 255;
constexpr std::size_t kMostPeers = 64;

/// Names and addresses of hosts and interfaces; nothing that means something in XML.
bool is_host(std::string_view text) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view(".:_-@%[]").find(c) != std::string_view::npos;
  };
  return !text.empty() && text.size() <= kLongestHost && std::all_of(text.begin(), text.end(), allowed);
}

bool is_address(const std::string& text) {
  in6_addr unused{};
  return ::inet_pton(AF_INET, text.c_str(), &unused) == 1 ||
         ::inet_pton(AF_INET6, text.c_str(), &unused) == 1;
}

/// The kernel does not say of `lo` that it can do multicast, but it can.
std::string interface_xml(const std::string& interface) {
  if (interface.empty()) return {};
  const std::string key = is_address(interface) ? "address" : "name";
  const std::string loopback = interface == "lo" ? " multicast=\"true\"" : "";
  return "<Interfaces><NetworkInterface " + key + "=\"" + interface + "\"" + loopback + "/></Interfaces>";
}

/// A peer looks for participants at the ports of indices 0 to 32, so ours must have such an index.
std::string peers_xml(const std::vector<std::string>& peers) {
  if (peers.empty()) return {};
  std::string xml =
      "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
      "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><Peers>";
  for (const std::string& peer : peers) xml += "<Peer address=\"" + peer + "\"/>";
  return xml + "</Peers></Discovery>";
}

bool has_ignoring_case(std::string_view text, std::string_view lower_case) {
  const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; };
  return std::search(text.begin(), text.end(), lower_case.begin(), lower_case.end(), same) != text.end();
}

tl::expected<std::string, std::string> read_user_file(const std::string& path) {
  const auto failed = [&](const std::string& why) { return Failed("Cyclone's file '" + path + "' " + why); };
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text(kLargestFile + 1, '\0');
  if (!file || (!file.read(text.data(), static_cast<std::streamsize>(text.size())) && !file.eof()))
    return failed(std::string("cannot be read: ") + std::strerror(errno));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kLargestFile) return failed("is larger than 1 MiB");
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos || text[begin] != '<' || text.find('\0') != std::string::npos)
    return failed("is not XML");
  if (has_ignoring_case(text, "sharedmemory"))
    return failed("speaks of SharedMemory: gvom's broker is none for Cyclone");
  return text.substr(begin);
}

/// Last of all too: what comes later counts.
const std::string kNoSharedMemory =
    "<CycloneDDS><Domain><SharedMemory><Enable>false</Enable></SharedMemory></Domain></CycloneDDS>";

/// With several threads that receive, Cyclone ends each by a packet to itself, and hangs where the network is
/// gone.
std::string own_xml(const DomainOptions& options) {
  return "<CycloneDDS><Domain Id=\"any\"><General>" + interface_xml(options.interface) +
         "<MaxMessageSize>65500B</MaxMessageSize><FragmentSize>63000B</FragmentSize></General>" +
         peers_xml(options.peers) +
         "<Internal><MultipleReceiveThreads>false</MultipleReceiveThreads><SocketReceiveBufferSize "
         "max=\"16MB\"/>"
         "<MaxSampleSize>" +
         std::to_string(kLargestMessage) +
         "B</MaxSampleSize></Internal><SharedMemory><Enable>false</Enable></SharedMemory></Domain></"
         "CycloneDDS>";
}

}  // namespace

tl::expected<std::string, std::string> domain_xml(const DomainOptions& options) {
  if (options.id < 0 || options.id > kLastDomain)
    return Failed("domain " + std::to_string(options.id) + " is not within 0 .. " +
                  std::to_string(kLastDomain));
  if (!options.interface.empty() && !is_host(options.interface))
    return Failed("interface '" + options.interface + "' is no name or address");
  if (options.peers.size() > kMostPeers) return Failed("more than " + std::to_string(kMostPeers) + " peers");
  for (const std::string& peer : options.peers)
    if (!is_host(peer)) return Failed("peer '" + peer + "' is no name or address");
  if (options.config_file.empty()) return own_xml(options);
  const auto users = read_user_file(options.config_file);
  if (!users) return Failed(users.error());
  return own_xml(options) + "," + *users + "," + kNoSharedMemory;
}

}  // namespace gvom::dds
