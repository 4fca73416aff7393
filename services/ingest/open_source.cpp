#include <map>
#include <utility>

#include "services/ingest/ouster_decoder.hpp"
#include "services/ingest/packet_sweep_source.hpp"
#include "services/ingest/pcap_reader.hpp"
#include "services/ingest/scan_source.hpp"
#include "services/ingest/udp_receiver.hpp"
#include "services/ingest/uri.hpp"
#include "services/ingest/velodyne_decoder.hpp"

namespace gvom::ingest {
namespace {

using SourceResult = tl::expected<std::unique_ptr<Source>, SourceError>;
using DecoderResult = tl::expected<std::unique_ptr<Decoder>, std::string>;
using PacketsResult = tl::expected<std::unique_ptr<PacketSource>, SourceError>;

DecoderResult make_decoder(const SourceUri& uri, const SourceOptions& options, SourceState& state) {
  const bool ouster = uri.scheme.compare(0, 6, "ouster") == 0;
  const auto needed = uri.option(ouster ? "meta" : "model");
  if (!needed) {
    return tl::unexpected("source '" + uri.text + "': needs " +
                          (ouster ? "meta=FILE.json" : "model=M (" + known_velodyne_models() + ")"));
  }
  if (ouster) {
    auto metadata = read_ouster_metadata(*needed, state.warnings);
    if (!metadata) return tl::unexpected(metadata.error());
    return std::make_unique<OusterDecoder>(std::move(*metadata), options, state);
  }
  const VelodyneModel* model = find_velodyne_model(*needed);
  if (model == nullptr) {
    return tl::unexpected("source '" + uri.text + "': unknown model '" + *needed + "' (" +
                          known_velodyne_models() + ")");
  }
  return std::make_unique<VelodyneDecoder>(*model, options, state);
}

/// Reads `path` up to the first packet that the decoder recognises; an error if there is none.
tl::expected<void, std::string> probe_recording(const std::string& path, std::optional<std::uint16_t> port,
                                                const Decoder& decoder) {
  SourceState ignored;
  auto reader = PcapReader::open(path, port, ignored);
  if (!reader) return tl::unexpected(reader.error());
  std::map<std::size_t, std::uint64_t> sizes;
  std::string cut;
  for (;;) {
    Packet packet;
    const auto event = (*reader)->next(packet, std::chrono::milliseconds(0));
    if (!event) return tl::unexpected(event.error());
    if (*event == PacketEvent::end) break;
    if (decoder.recognises(packet)) return {};
    ++sizes[packet.size];
  }
  if (!ignored.warnings.empty())
    return tl::unexpected(ignored.warnings.front() + ", but there is no lidar packet");
  if ((*reader)->records() == 0) return tl::unexpected(path + ": holds no packets");
  std::string found;
  for (const auto& [size, count] : sizes) {
    if (found.size() > 200) break;
    found += (found.empty() ? "" : ", ") + std::to_string(count) + " of " + std::to_string(size) + " bytes";
  }
  return tl::unexpected(path + ": no packet is of the sensor that is asked for (" + decoder.expects() +
                        "); UDP packets in the recording" +
                        (port ? " to port " + std::to_string(*port) : "") + ": " +
                        (found.empty() ? "none" : found));
}

PacketsResult open_recording(const SourceUri& uri, const Decoder& decoder, SourceState& state) {
  const auto port = port_option(uri);
  if (!port) return tl::unexpected(port.error());
  const auto probed = probe_recording(uri.path, *port, decoder);
  if (!probed) return tl::unexpected(probed.error());
  return PcapReader::open(uri.path, *port, state);
}

PacketsResult open_live(const SourceUri& uri, SourceState& state) {
  const auto port = parse_port(uri.path);
  if (!port) return tl::unexpected("source '" + uri.text + "': " + port.error());
  return UdpReceiver::open(*port, uri.option("bind").value_or(""), state);
}

SourceResult open_packets(const SourceUri& uri, const SourceOptions& options, bool live) {
  auto state = std::make_unique<SourceState>();
  auto decoder = make_decoder(uri, options, *state);
  if (!decoder) return tl::unexpected(decoder.error());
  auto packets = live ? open_live(uri, *state) : open_recording(uri, **decoder, *state);
  if (!packets) return tl::unexpected(packets.error());
  return std::make_unique<PacketSweepSource>(std::move(state), std::move(*packets), std::move(*decoder));
}

}  // namespace

tl::expected<std::unique_ptr<Source>, SourceError> open_source(const std::string& text,
                                                               const SourceOptions& options) {
  const auto uri = parse_source_uri(text);
  if (!uri) return tl::unexpected(uri.error());
  const std::map<std::string, std::set<std::string>> schemes = {
      {"ouster", {"meta", "port"}},
      {"ouster-udp", {"meta", "bind"}},
      {"velodyne", {"model", "port"}},
      {"velodyne-udp", {"model", "bind"}},
      {"scans", {}},
  };
  const auto scheme = schemes.find(uri->scheme);
  if (scheme == schemes.end()) {
    return tl::unexpected("source '" + text + "': unknown scheme '" + uri->scheme +
                          "' (ouster, ouster-udp, velodyne, velodyne-udp, scans)");
  }
  const auto checked = check_options(*uri, scheme->second);
  if (!checked) return tl::unexpected(checked.error());
  if (uri->scheme == "scans") return ScanSource::open(uri->path, options);
  const bool live = uri->scheme == "ouster-udp" || uri->scheme == "velodyne-udp";
  return open_packets(*uri, options, live);
}

}  // namespace gvom::ingest
