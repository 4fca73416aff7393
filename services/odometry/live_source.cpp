#include "services/odometry/live_source.hpp"

#include <set>

#include "services/common/dds/names.hpp"
#include "services/common/source_uri.hpp"

namespace gvom::odometry {

tl::expected<LiveSource, std::string> parse_live_source(const std::string& source) {
  const auto wrong = [&](const std::string& why) {
    return tl::unexpected("odometry source '" + source + "': " + why);
  };
  auto uri = services::parse_source_uri(source);
  if (!uri) return tl::unexpected("odometry " + uri.error());
  std::set<std::string> allowed(dds::kNetworkOptions.begin(), dds::kNetworkOptions.end());
  allowed.insert("tf");
  if (const auto checked = services::check_options(*uri, allowed); !checked)
    return tl::unexpected("odometry " + checked.error());
  LiveSource out;
  out.topic = uri->path;
  if (const auto frames = uri->option("tf")) {
    auto parsed = services::parse_frames(*frames);
    if (!parsed) return wrong(parsed.error());
    out.tf = std::move(*parsed);
  }
  if (const auto name = dds::topic_on_wire(out.topic); !name) return wrong(name.error());
  auto network = dds::network_options(uri->options, "/gvom_odometry", out.topic);
  if (!network) return wrong(network.error());
  out.network = std::move(*network);
  return out;
}

}  // namespace gvom::odometry
