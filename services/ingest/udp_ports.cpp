#include "services/ingest/udp_ports.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "services/common/source_uri.hpp"

namespace gvom::ingest {

namespace {

namespace fs = std::filesystem;

std::string read_text(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

bool has_socket(const fs::path& process, const std::vector<std::string>& links) {
  std::error_code error;
  for (fs::directory_iterator fd(process / "fd", error), end; !error && fd != end; fd.increment(error)) {
    std::error_code gone;
    const std::string link = fs::read_symlink(fd->path(), gone);
    if (!gone && std::find(links.begin(), links.end(), link) != links.end()) return true;
  }
  return false;
}

}  // namespace

std::vector<std::uint64_t> sockets_on(const std::string& table, std::uint16_t port) {
  std::vector<std::uint64_t> inodes;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::string slot, local, skipped;
    if (!(fields >> slot >> local) || slot.back() != ':') continue;  // the headline
    const std::size_t colon = local.rfind(':');
    if (colon == std::string::npos || std::stoul(local.substr(colon + 1), nullptr, 16) != port) continue;
    for (int i = 0; i < 7; ++i)
      fields >> skipped;  // remote, state, queues, timer, retransmits, user, timeout
    std::uint64_t inode = 0;
    if (fields >> inode) inodes.push_back(inode);
  }
  return inodes;
}

std::optional<PortHolder> owner_of_port(std::uint16_t port) {
  std::vector<std::string> links;
  for (const char* table : {"/proc/net/udp", "/proc/net/udp6"})
    for (const std::uint64_t inode : sockets_on(read_text(table), port))
      links.push_back("socket:[" + std::to_string(inode) + "]");
  if (links.empty()) return std::nullopt;
  std::error_code error;
  for (fs::directory_iterator process("/proc", error), end; !error && process != end;
       process.increment(error)) {
    const std::string name = process->path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos || !has_socket(process->path(), links))
      continue;
    std::string command = read_text(process->path() / "cmdline");
    std::replace(command.begin(), command.end(), '\0', ' ');
    command.erase(command.find_last_not_of(' ') + 1);
    return PortHolder{std::stoi(name), command};
  }
  return std::nullopt;
}

bool is_ingest_of(const PortHolder& owner, const std::string& lidar) {
  const std::string words = owner.command + " ";
  return words.find("gvom-ingest") != std::string::npos &&
         (words.find("--lidar " + lidar + " ") != std::string::npos ||
          words.find("--lidar=" + lidar + " ") != std::string::npos);
}

std::optional<std::uint16_t> live_port(const std::string& source) {
  const auto uri = services::parse_source_uri(source);
  if (!uri || (uri->scheme != "ouster-udp" && uri->scheme != "velodyne-udp")) return std::nullopt;
  const auto port = services::parse_port(uri->path);
  return port ? std::optional<std::uint16_t>(*port) : std::nullopt;
}

}  // namespace gvom::ingest
