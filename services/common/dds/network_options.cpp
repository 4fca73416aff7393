#include "services/common/dds/network_options.hpp"

#include <algorithm>
#include <charconv>
#include <vector>

namespace gvom::dds {
namespace {

std::vector<std::string> parts_of(const std::string& list) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    parts.push_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace

tl::expected<ParticipantOptions, std::string> network_options(
    const std::map<std::string, std::string>& options, const std::string& prefix, const std::string& topic) {
  const auto option = [&](const char* key) {
    const auto found = options.find(key);
    return found == options.end() ? std::string() : found->second;
  };
  ParticipantOptions out;
  if (const std::string text = option("domain"); !text.empty()) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out.domain.id);
    if (error != std::errc{} || end != text.data() + text.size())
      return tl::unexpected("domain: '" + text + "' is not a whole number");
  }
  const std::string distro = option("distro");
  if (!distro.empty() && distro != "humble" && distro != "jazzy")
    return tl::unexpected("distro: expected humble or jazzy, not '" + distro + "'");
  out.distro = distro == "humble" ? Distro::humble : Distro::jazzy;
  out.domain.interface = option("interface");
  out.domain.peers = parts_of(option("peers"));
  out.domain.config_file = option("config");
  out.node = prefix + topic;
  std::replace(out.node.begin() + 1, out.node.end(), '/', '_');
  if (const auto xml = domain_xml(out.domain); !xml) return tl::unexpected(xml.error());
  return out;
}

}  // namespace gvom::dds
