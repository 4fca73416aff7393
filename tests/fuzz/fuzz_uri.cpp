// Source URIs, their options and ports; nothing is opened.
#include "services/common/source_uri.hpp"
#include "services/ingest/udp_socket.hpp"
#include "tests/fuzz/input.hpp"

using namespace gvom;
using namespace gvom::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto uri = services::parse_source_uri(text);
  require(uri || !uri.error().empty(), "an error says what it is");
  if (!uri) return 0;
  require(!uri->scheme.empty() && !uri->path.empty(), "a source has a scheme and a path");
  for (const auto& [key, value] : uri->options)
    require(!key.empty() && !value.empty(), "an option has a value");
  const auto port = services::parse_port(uri->path);
  require(!port || *port > 0, "port 0 is none");
  (void)services::port_option(*uri);
  (void)ingest::from_option(*uri);
  if (const auto live = ingest::udp_options(*uri)) {
    require(!live->group || ingest::is_multicast(*live->group), "a group is a multicast group");
    require(!live->group || !live->bind, "a group is no address of this machine");
  }
  (void)services::check_options(*uri, {"meta", "port"});
  return 0;
}
