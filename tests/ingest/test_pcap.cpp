// Captures of every kind, and files that are none.
#include "services/ingest/pcap_reader.hpp"
#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using namespace gvom::ingest;

namespace {

constexpr std::int64_t kTimeNs = 1'600'000'000'123'456'789;

/// The one payload of a capture with one frame, or nothing.
std::optional<ByteVector> payload_of(const ByteVector& frame_bytes, std::uint32_t link_type,
                                     std::int64_t* time_ns = nullptr) {
  TemporaryFolder folder;
  PcapWriter pcap(folder.path() + "/a.pcap", link_type, true);
  pcap.add(frame_bytes, kTimeNs);
  SourceState state;
  auto reader = PcapReader::open(pcap.write(), std::nullopt, state);
  REQUIRE(reader.has_value());
  Packet packet;
  const auto event = (*reader)->next(packet, std::chrono::milliseconds(0));
  REQUIRE(event.has_value());
  if (*event == PacketEvent::end) return std::nullopt;
  if (time_ns != nullptr) *time_ns = packet.capture_ns;
  return ByteVector(packet.data, packet.data + packet.size);
}

ByteVector prefixed(ByteVector prefix, const ByteVector& rest) {
  append(prefix, rest);
  return prefix;
}

}  // namespace

TEST_CASE("every link type gives the same payload, with its nanoseconds") {
  const ByteVector payload{1, 2, 3, 4, 5};
  const ByteVector ip = ipv4(udp(payload));
  std::int64_t time_ns = 0;
  CHECK(payload_of(ethernet(ip), 1, &time_ns) == payload);
  CHECK(time_ns == kTimeNs);
  CHECK(payload_of(ethernet(prefixed({0, 5, 0x08, 0x00}, ip), 0x8100), 1) == payload);  // VLAN
  CHECK(payload_of(ethernet(prefixed({0, 5, 0x81, 0, 0, 6, 0x08, 0x00}, ip), 0x88A8), 1) == payload);
  CHECK(payload_of(prefixed({0, 0, 0, 1, 0, 6, 0, 0, 0, 0, 0, 0, 0, 0, 0x08, 0x00}, ip), 113) == payload);
  CHECK(payload_of(prefixed({0x08, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 6, 0, 0, 0, 0, 0, 0, 0, 0}, ip), 276) ==
        payload);
  const ByteVector cooked{0, 0, 0, 1, 0, 6, 0, 0, 0, 0, 0, 0, 0, 0};
  const ByteVector tagged = prefixed({0, 5, 0x08, 0x00}, ip);
  const ByteVector twice = prefixed({0, 5, 0x81, 0x00, 0, 6, 0x08, 0x00}, ip);
  CHECK(payload_of(prefixed(prefixed(cooked, {0x81, 0x00}), tagged), 113) == payload);
  CHECK(payload_of(prefixed(prefixed(cooked, {0x88, 0xA8}), twice), 113) == payload);
  const ByteVector cooked2{0, 0, 0, 0, 0, 1, 0, 1, 0, 6, 0, 0, 0, 0, 0, 0, 0, 0};
  CHECK(payload_of(prefixed(prefixed({0x81, 0x00}, cooked2), tagged), 276) == payload);
  CHECK(payload_of(prefixed(prefixed({0x88, 0xA8}, cooked2), twice), 276) == payload);
  CHECK(payload_of(prefixed({0xFF, 0x03, 0x00, 0x21}, ip), 9) == payload);
  CHECK(payload_of(prefixed({0x00, 0x21}, ip), 9) == payload);
  CHECK_FALSE(payload_of(prefixed({0xFF, 0x03, 0xC0, 0x21}, ip), 9).has_value());  // not IP
  CHECK(payload_of(ip, 101) == payload);
  CHECK(payload_of(prefixed({2, 0, 0, 0}, ip), 0) == payload);
  CHECK(payload_of(ethernet(ipv6(udp(payload)), 0x86DD), 1) == payload);
}

TEST_CASE("frames that lie about their lengths give nothing") {
  const ByteVector good = frame({1, 2, 3, 4});
  for (std::size_t size = 0; size < good.size(); ++size) {
    CHECK_FALSE(payload_of(ByteVector(good.begin(), good.begin() + static_cast<long>(size)), 1).has_value());
  }
  ByteVector header = good;
  header[14] = 0x44;  // an IP header of 16 bytes
  CHECK_FALSE(payload_of(header, 1).has_value());
  ByteVector length = good;
  length[39] = 200;  // a UDP length beyond the packet
  CHECK_FALSE(payload_of(length, 1).has_value());
}

TEST_CASE("fragments that do not fit together are given up, not joined") {
  TemporaryFolder folder;
  PcapWriter pcap(folder.path() + "/a.pcap");
  const ByteVector body(16, 7);
  pcap.add(ethernet(ipv4(body, {1, 1, 5}, 0x2000 | 8)));
  pcap.add(ethernet(ipv4(body, {1, 1, 5}, 2)));                     // ends before the first one begins
  pcap.add(ethernet(ipv4(ByteVector(13, 7), {1, 1, 6}, 0x2000)));   // not a multiple of 8
  pcap.add(ethernet(ipv4(ByteVector(800, 7), {1, 1, 7}, 0x1FFF)));  // beyond 64 KiB
  for (std::uint16_t id = 100; id < 120; ++id) pcap.add(ethernet(ipv4(body, {1, 1, id}, 0x2000)));
  SourceState state;
  auto reader = PcapReader::open(pcap.write(), std::nullopt, state);
  REQUIRE(reader.has_value());
  Packet packet;
  CHECK((*reader)->next(packet, std::chrono::milliseconds(0)).value() == PacketEvent::end);
  CHECK(state.counters.fragments == 24);
  CHECK(state.counters.lost_fragments == 23);
}

TEST_CASE("files that are no recording are refused with path and reason") {
  TemporaryFolder folder;
  const std::string meta = "?meta=" + write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const auto error_of = [&](const std::string& path) { return open_error("ouster:" + path + meta); };
  CHECK(error_of(folder.path() + "/none.pcap").find("none.pcap: No such file") != std::string::npos);
  CHECK(error_of(write_text(folder.path() + "/empty.pcap", "")).find("not a pcap file") != std::string::npos);
  CHECK(
      error_of(write_text(folder.path() + "/text.pcap", "Hello, I am no capture.")).find("not a pcap file") !=
      std::string::npos);
  CHECK(error_of(folder.path()).find("not a pcap file") != std::string::npos);
  CHECK(error_of(PcapWriter(folder.path() + "/header.pcap").write()).find("holds no packets") !=
        std::string::npos);
  PcapWriter wifi(folder.path() + "/wifi.pcap", 105);
  wifi.add(ByteVector(100));
  CHECK(error_of(wifi.write()).find("link type") != std::string::npos);
  PcapWriter cut(folder.path() + "/cut.pcap");
  cut.add(frame(plain_packet({}, 1, 0)));
  CHECK(error_of(cut.write(5)).find("packet 1: cut off by the end of the file") != std::string::npos);
}

TEST_CASE("a recording that is cut off gives what was before the cut, and a warning") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  PcapWriter pcap(folder.path() + "/cut.pcap");
  for (int id = 1; id <= 2; ++id) {
    for (int column = 0; column < 16; column += 4) pcap.add(frame(plain_packet({}, id, column)));
  }
  auto source = open("ouster:" + pcap.write(7) + "?meta=" + meta);
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 2);
  CHECK(sweeps[0].complete);
  CHECK_FALSE(sweeps[1].complete);
  REQUIRE(source->warnings().size() == 1);
  CHECK(source->warnings()[0].find("cut.pcap: packet 8: cut off") != std::string::npos);
}

TEST_CASE("a corrupt record is an error with its number, after the sweeps before it; then comes the end") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  PcapWriter pcap(folder.path() + "/bad.pcap");
  for (int column = 0; column < 16; column += 4) pcap.add(frame(plain_packet({}, 1, column)));
  const std::string path = pcap.write();
  {
    std::ofstream file(path, std::ios::binary | std::ios::app);
    const ByteVector nonsense(4000, 0xFE);
    file.write(reinterpret_cast<const char*>(nonsense.data()), 4000);
  }
  auto source = open("ouster:" + path + "?meta=" + meta);
  Sweep sweep;
  CHECK(source->next(sweep, std::chrono::milliseconds(0)).value() == SourceEvent::kSweep);
  const auto bad = source->next(sweep, std::chrono::milliseconds(0));
  REQUIRE_FALSE(bad.has_value());
  CHECK(bad.error().find("bad.pcap: packet 5: ") != std::string::npos);
  CHECK(source->next(sweep, std::chrono::milliseconds(0)).value() == SourceEvent::kEnd);
}
