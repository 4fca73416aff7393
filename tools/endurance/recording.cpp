#include "tools/endurance/recording.hpp"

#include <algorithm>

#include "services/common/odometry_file.hpp"
#include "services/ingest/bytes.hpp"
#include "services/ingest/pcap_reader.hpp"

namespace gvom::endurance {

namespace {

constexpr std::size_t kFrameAt = 2;  // in the packet

using Packets = std::vector<TimedPacket>;

tl::expected<Packets, std::string> read_packets(const std::string& path, std::uint32_t lidar,
                                                std::int64_t begin_ns) {
  ingest::SourceState state;
  auto reader = ingest::PcapReader::open(path, std::nullopt, state);
  if (!reader) return tl::make_unexpected(reader.error());
  Packets packets;
  ingest::Packet packet;
  while (true) {
    const auto event = (*reader)->next(packet, std::chrono::milliseconds{0});
    if (!event) return tl::make_unexpected(event.error());
    if (*event == ingest::PacketEvent::end) break;
    if (packet.size < kFrameAt + sizeof(std::uint16_t))
      return tl::make_unexpected(path + ": a packet is too short");
    const auto frame = ingest::load_le<std::uint16_t>(packet.data + kFrameAt);
    packets.push_back({packet.capture_ns - begin_ns, lidar, frame, {packet.data, packet.data + packet.size}});
  }
  if (packets.empty()) return tl::make_unexpected(path + ": no packets in it");
  return packets;
}

/// Whole frames alone, numbered from 0, none of which ends after `latest_ns`. Returns how many.
std::uint64_t keep_frames(Packets& packets, std::int64_t latest_ns) {
  const std::uint16_t first = packets.front().frame;
  for (TimedPacket& packet : packets) packet.frame = static_cast<std::uint16_t>(packet.frame - first);
  int frames = packets.back().frame + 1;
  for (const TimedPacket& packet : packets)
    if (packet.due_ns > latest_ns) frames = std::min<int>(frames, packet.frame);
  packets.erase(std::remove_if(packets.begin(), packets.end(),
                               [frames](const TimedPacket& packet) { return packet.frame >= frames; }),
                packets.end());
  return static_cast<std::uint64_t>(frames);
}

}  // namespace

tl::expected<Recording, std::string> read_recording(const std::string& folder,
                                                    const std::vector<std::string>& lidars) {
  std::vector<std::string> warnings;
  const auto poses = services::read_odometry_source("tum:" + folder + "/odometry.tum", warnings);
  if (!poses) return tl::make_unexpected(poses.error());
  if (!warnings.empty()) return tl::make_unexpected(warnings.front());
  const std::int64_t begin_ns = poses->front().stamp_ns;
  const std::int64_t latest_ns = poses->back().stamp_ns - begin_ns - kQuiet_ns;
  Recording recording;
  for (std::uint32_t lidar = 0; lidar < lidars.size(); ++lidar) {
    const std::string path = folder + "/" + lidars[lidar] + ".pcap";
    auto packets = read_packets(path, lidar, begin_ns);
    if (!packets) return tl::make_unexpected(packets.error());
    recording.sweeps.push_back(keep_frames(*packets, latest_ns));
    if (packets->empty()) return tl::make_unexpected(path + ": shorter than one turn of the lidar");
    std::move(packets->begin(), packets->end(), std::back_inserter(recording.packets));
  }
  std::stable_sort(recording.packets.begin(), recording.packets.end(),
                   [](const TimedPacket& a, const TimedPacket& b) { return a.due_ns < b.due_ns; });
  return recording;
}

}  // namespace gvom::endurance
