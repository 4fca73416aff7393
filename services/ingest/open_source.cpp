#include <map>
#include <utility>

#include "services/common/source_uri.hpp"
#include "services/ingest/bag_source.hpp"
#include "services/ingest/make_decoder.hpp"
#include "services/ingest/packet_sweep_source.hpp"
#include "services/ingest/pcap_reader.hpp"
#include "services/ingest/probe.hpp"
#include "services/ingest/ros2_source.hpp"
#include "services/ingest/scan_source.hpp"
#include "services/ingest/udp_receiver.hpp"

namespace gvom::ingest {
namespace {

using SourceResult = tl::expected<std::unique_ptr<Source>, SourceError>;
using PacketsResult = tl::expected<std::unique_ptr<PacketSource>, SourceError>;

DecoderResult make_decoder(const services::SourceUri& uri, const SourceOptions& options, SourceState& state) {
  const bool ouster = uri.scheme.compare(0, 6, "ouster") == 0;
  return ouster ? make_ouster_decoder(uri, options, state) : make_velodyne_decoder(uri, options, state);
}

/// Reads `path` up to the first packet that the decoder recognises; an error if there is none.
tl::expected<void, std::string> probe_recording(const std::string& path, std::optional<std::uint16_t> port,
                                                Decoder& decoder) {
  SourceState ignored;
  auto reader = PcapReader::open(path, port, ignored);
  if (!reader) return tl::unexpected(reader.error());
  const auto strangers = look_for_sensor(**reader, decoder);
  if (!strangers) return tl::unexpected(strangers.error());
  if (strangers->found) return {};
  if (strangers->of_another.empty() && !ignored.warnings.empty())
    return tl::unexpected(ignored.warnings.front() + ", but there is no lidar packet");
  if ((*reader)->records() == 0) return tl::unexpected(path + ": holds no packets");
  return tl::unexpected(
      no_such_packets(*strangers, decoder, path,
                      "UDP packets in the recording" + (port ? " to port " + std::to_string(*port) : "")));
}

PacketsResult open_recording(const services::SourceUri& uri, Decoder& decoder, SourceState& state) {
  const auto port = services::port_option(uri);
  if (!port) return tl::unexpected(port.error());
  const auto probed = probe_recording(uri.path, *port, decoder);
  if (!probed) return tl::unexpected(probed.error());
  return PcapReader::open(uri.path, *port, state);
}

PacketsResult open_live(const services::SourceUri& uri, SourceState& state) {
  const auto options = udp_options(uri);
  if (!options) return tl::unexpected(options.error());
  return UdpReceiver::open(*options, state);
}

SourceResult open_packets(const services::SourceUri& uri, const SourceOptions& options, bool live) {
  auto state = std::make_unique<SourceState>();
  auto decoder = make_decoder(uri, options, *state);
  if (!decoder) return tl::unexpected(decoder.error());
  auto packets = live ? open_live(uri, *state) : open_recording(uri, **decoder, *state);
  if (!packets) return tl::unexpected(packets.error());
  const auto from = from_option(uri);
  if (!from) return tl::unexpected(from.error());
  return std::make_unique<PacketSweepSource>(std::move(state), std::move(*packets), std::move(*decoder),
                                             options, *from);
}

SourceResult open_scans(const services::SourceUri& uri, const SourceOptions& options) {
  ScanSource::Format format;
  if (const auto text = uri.option("floats")) {
    if (*text != "4" && *text != "5" && *text != "6")
      return tl::unexpected("source '" + uri.text + "': floats=" + *text + ": expected 4, 5 or 6");
    format.floats = static_cast<std::size_t>((*text)[0] - '0');
  }
  if (const auto text = uri.option("time")) {
    format.time = parse_time_unit(*text);
    if (!format.time)
      return tl::unexpected("source '" + uri.text + "': time=" + *text + ": expected ns, us, ms, s or none");
  }
  return ScanSource::open(uri.path, options, format);
}

}  // namespace

std::string lack_of_room(const std::string& lidar, std::size_t max_returns, const Source& source) {
  const std::size_t needed = source.most_returns();
  if (needed <= max_returns) return "";
  return "lidars." + lidar + ".max_returns is " + std::to_string(max_returns) + ", and a sweep can have " +
         std::to_string(needed) + " returns: its cloud would be cut; make it " + std::to_string(needed);
}

tl::expected<std::unique_ptr<Source>, SourceError> open_source(const std::string& text,
                                                               const SourceOptions& options) {
  const auto uri = services::parse_source_uri(text);
  if (!uri) return tl::unexpected(uri.error());
  const std::map<std::string, std::set<std::string>> schemes = {
      {"bag", {"calibration", "deskew", "meta", "model", "model_byte", "returns", "serial", "time", "topic"}},
      {"ouster", {"from", "meta", "port", "serial"}},
      {"ouster-udp", {"bind", "from", "group", "interface", "meta", "serial"}},
      {"velodyne", {"calibration", "from", "model", "model_byte", "port", "returns"}},
      {"velodyne-udp",
       {"bind", "calibration", "from", "group", "interface", "model", "model_byte", "returns"}},
      {"scans", {"floats", "time"}},
  };
  if (uri->scheme == "ros2") return open_ros2_source(*uri, options);  // its options depend on each other
  const auto scheme = schemes.find(uri->scheme);
  if (scheme == schemes.end()) {
    return tl::unexpected("source '" + text + "': unknown scheme '" + uri->scheme +
                          "' (bag, ouster, ouster-udp, ros2, velodyne, velodyne-udp, scans)");
  }
  const auto checked = services::check_options(*uri, scheme->second);
  if (!checked) return tl::unexpected(checked.error());
  if (uri->scheme == "scans" && options.by_arrival)
    return tl::unexpected("source '" + text +
                          "': clock: arrival needs packets; scans have no times of arrival");
  if (uri->scheme == "scans") return open_scans(*uri, options);
  if (uri->scheme == "bag") return open_bag_source(*uri, options);
  const bool live = uri->scheme == "ouster-udp" || uri->scheme == "velodyne-udp";
  return open_packets(*uri, options, live);
}

}  // namespace gvom::ingest
