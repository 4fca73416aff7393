// Captures of every kind, and files that are none.
#include <zlib.h>

#include <unistd.h>

#include <random>

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

namespace {

/// A whole frame of the small sensor, in a capture that `add` fills.
template <class Add>
std::string capture(const TemporaryFolder& folder, Add add) {
  PcapWriter pcap(folder.path() + "/a.pcap");
  for (int column = 0; column < 16; column += 4) add(pcap, plain_packet({}, 1, column), column);
  return pcap.write();
}

ByteVector read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string write_bytes(const std::string& path, const ByteVector& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
  return path;
}

std::string gzipped(const std::string& path, const ByteVector& bytes) {
  const gzFile file = ::gzopen(path.c_str(), "wb");
  REQUIRE(::gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size())) ==
          static_cast<int>(bytes.size()));
  REQUIRE(::gzclose(file) == Z_OK);
  return path;
}

}  // namespace

TEST_CASE(
    "packets that were not captured whole are warned of, with what to do; if all are, that is the error") {
  TemporaryFolder folder;
  const std::string meta = "?meta=" + write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const std::string all = capture(
      folder, [](PcapWriter& pcap, const ByteVector& payload, int) { pcap.add(frame(payload), 0, 20); });
  const std::string error = open_error("ouster:" + all + meta);
  CHECK(error.find("a.pcap: packet 1: captured with a snap length, ") != std::string::npos);
  CHECK(error.find("capture again with -s 0") != std::string::npos);
  const std::string some = capture(folder, [](PcapWriter& pcap, const ByteVector& payload, int column) {
    pcap.add(frame(payload), 0, column == 8 ? 20 : 0);
  });
  auto source = open("ouster:" + some + meta);
  CHECK(all_sweeps(*source).size() == 1);
  CHECK(source->counters().truncated_packets == 1);
  REQUIRE(source->warnings().size() == 1);
  CHECK(source->warnings()[0].find("packet 3: captured with a snap length") != std::string::npos);
}

TEST_CASE("first fragments alone are what a filter by port leaves: that is said") {
  TemporaryFolder folder;
  const std::string meta = "?meta=" + write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const auto first_only = [](PcapWriter& pcap, const ByteVector& payload, int column) {
    pcap.add(fragments(payload, 64, {1, 7502, static_cast<std::uint16_t>(column)}).front());
  };
  const std::string error = open_error("ouster:" + capture(folder, first_only) + meta);
  CHECK(error.find("4 datagrams") != std::string::npos);
  CHECK(error.find("udp or (ip[6:2] & 0x1fff != 0)") != std::string::npos);
  const auto one_lost = [](PcapWriter& pcap, const ByteVector& payload, int column) {
    const auto parts = fragments(payload, 64);
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (column != 8 || i != 1) pcap.add(parts[i]);
  };
  auto source = open("ouster:" + capture(folder, one_lost) + meta);  // no filter, but a loss
  CHECK(all_sweeps(*source).size() == 1);
  CHECK(source->counters().lost_fragments == 1);
  CHECK(source->warnings().empty());
}

TEST_CASE("a capture packed by gzip is read, also from its start again; other packers are named") {
  TemporaryFolder folder;
  const std::string meta = "?meta=" + write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const ByteVector plain = read_bytes(
      capture(folder, [](PcapWriter& pcap, const ByteVector& payload, int) { pcap.add(frame(payload)); }));
  const std::string packed = gzipped(folder.path() + "/a.pcap.gz", plain);
  auto source = open("ouster:" + packed + meta);
  CHECK(all_sweeps(*source).size() == 1);
  REQUIRE(source->rewind().has_value());
  CHECK(all_sweeps(*source).size() == 1);
  CHECK(source->warnings().empty());

  const ByteVector cut(plain.begin(), plain.end() - 7);
  auto shorter = open("ouster:" + gzipped(folder.path() + "/cut.pcap.gz", cut) + meta);
  CHECK(all_sweeps(*shorter).size() == 1);
  REQUIRE(shorter->warnings().size() == 1);
  CHECK(shorter->warnings()[0].find("packet 4: cut off") != std::string::npos);

  CHECK(open_error("ouster:" + gzipped(folder.path() + "/text.gz", ByteVector(100, 'x')) + meta)
            .find("not a pcap file") != std::string::npos);
  const std::string zstd = write_bytes(folder.path() + "/a.pcap.zst", {0x28, 0xB5, 0x2F, 0xFD, 0, 0, 0, 0});
  CHECK(open_error("ouster:" + zstd + meta).find("is packed by zstd: unpack it first: unzstd " + zstd) !=
        std::string::npos);
  const std::string xz = write_bytes(folder.path() + "/a.pcap.xz", {0xFD, '7', 'z', 'X', 'Z', 0, 0, 0});
  CHECK(open_error("ouster:" + xz + meta).find("unxz") != std::string::npos);
}

TEST_CASE("a gzip file that is damaged is an error, after the sweeps before the damage") {
  TemporaryFolder folder;
  const std::string meta = "?meta=" + write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  PcapWriter pcap(folder.path() + "/a.pcap");
  std::minstd_rand random(1);
  for (int id = 1; id <= 5000; ++id)
    for (int column = 0; column < 16; column += 4)
      pcap.add(frame(plain_packet({}, id, column, static_cast<std::uint32_t>(1 + random() % 100000))));
  const std::string packed = gzipped(folder.path() + "/a.pcap.gz", read_bytes(pcap.write()));
  ByteVector bytes = read_bytes(packed);
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 200; ++i) bytes[i] ^= 0x55;
  write_bytes(packed, bytes);
  auto source = open("ouster:" + packed + meta);
  Sweep sweep;
  int sweeps = 0;
  auto event = source->next(sweep, std::chrono::milliseconds(0));
  for (; event && *event == SourceEvent::kSweep; ++sweeps)
    event = source->next(sweep, std::chrono::milliseconds(0));
  REQUIRE_FALSE(event.has_value());
  CHECK(event.error().find("a.pcap.gz: packet ") != std::string::npos);
  CHECK(sweeps > 0);
  CHECK(sweeps < 5000);
}

TEST_CASE("a recording in which the capture's time goes back is read on, and every packet is accounted for") {
  TemporaryFolder folder;
  const std::string meta = "?meta=" + write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  PcapWriter pcap(folder.path() + "/a.pcap");
  constexpr std::int64_t kSecond = 1'000'000'000;
  for (int pass = 0; pass < 2; ++pass)
    for (int id = 1; id <= 20; ++id)
      for (int column = 0; column < 16; column += 4)
        pcap.add(frame(plain_packet({}, id, column)), 1000 * kSecond + id * kSecond / 10);
  auto source = open("ouster:" + pcap.write() + meta);
  const auto sweeps = all_sweeps(*source);
  CHECK(sweeps.size() >= 38);  // two frames tell that it starts again
  const SourceCounters& counters = source->counters();
  CHECK(counters.packets == 160);
  const std::uint64_t unused = counters.late_packets + counters.duplicate_packets + counters.foreign_packets;
  CHECK(unused == 7);
  CHECK(counters.columns == 4 * (160 - unused));
}

TEST_CASE("a recording of two sensors gives one, and says whose packets are not used and how to have them") {
  TemporaryFolder folder;
  const std::string meta = "?meta=" + write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  PcapWriter pcap(folder.path() + "/a.pcap");
  constexpr std::int64_t kTenth = 100'000'000;
  for (int id = 1; id <= 20; ++id)
    for (std::uint8_t host : {std::uint8_t{1}, std::uint8_t{2}})  // in bursts, longer than a stray few
      for (int half = 0; half < 2; ++half)
        for (int column = 0; column < 16; column += 4)
          pcap.add(frame(plain_packet({}, 2 * id + half, column, 5000U * host), {host, 7502, 1}),
                   1000 * kTenth + id * kTenth);
  const std::string uri = "ouster:" + pcap.write() + meta;
  auto source = open(uri);
  const auto sweeps = all_sweeps(*source);
  CHECK(sweeps.size() == 40);
  for (const Sweep& sweep : sweeps) CHECK(sweep.returns.front().x_m == Approx(5.0).margin(0.01));
  CHECK(source->counters().second_sensor_packets == 160);
  REQUIRE(source->warnings().size() == 1);
  CHECK(source->warnings()[0].find("from 10.0.0.1 and from 10.0.0.2") != std::string::npos);
  auto other = open(uri + "&from=10.0.0.2");
  CHECK(all_sweeps(*other).size() == 40);
  CHECK(other->counters().second_sensor_packets == 160);
}

TEST_CASE("what a sweep can have is held against max_returns") {
  TemporaryFolder folder;
  OusterSensor sensor;
  sensor.beams = 128;
  sensor.columns = 1024;
  sensor.window = "[0, 1023]";
  sensor.altitudes = "[";
  sensor.azimuths = "[";
  for (int beam = 0; beam < 128; ++beam) {
    sensor.altitudes += (beam == 0 ? "" : ", ") + std::to_string(20.0 - 0.3 * beam);
    sensor.azimuths += beam == 0 ? "3" : beam % 2 == 0 ? ", 3" : ", -3";
  }
  sensor.altitudes += "]";
  sensor.azimuths += "]";
  for (const auto& [profile, returns] :
       {std::pair("LEGACY", 131072U), {"RNG19_RFL8_SIG16_NIR16_DUAL", 262144U}}) {
    sensor.profile = profile;
    const std::string meta = write_text(folder.path() + "/meta.json", sensor.json());
    const auto source = open("ouster-udp:" + std::to_string(20000 + ::getpid() % 20000) + "?meta=" + meta);
    CHECK(source->most_returns() == returns);
    CHECK(lack_of_room("front", returns, *source).empty());
    const std::string lack = lack_of_room("front", 65536, *source);
    CHECK(lack.find("lidars.front.max_returns is 65536") == 0);
    CHECK(lack.find(std::to_string(returns)) != std::string::npos);
  }
  const auto port = std::to_string(20000 + ::getpid() % 20000);
  const auto single = open("velodyne-udp:" + port + "?model=VLP-32C&returns=single")->most_returns();
  const auto dual = open("velodyne-udp:" + port + "?model=VLP-32C&returns=dual")->most_returns();
  CHECK(dual == 2 * single);
  CHECK(dual > 65536);
}

TEST_CASE("a pcapng of interfaces of several kinds is refused with what helps") {
  TemporaryFolder folder;
  const std::string meta = "?meta=" + write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  ByteVector ng;
  const auto words = [&](const std::vector<std::uint32_t>& all) {
    for (const std::uint32_t word : all) put_le(ng, word);
  };
  words({0x0A0D0D0A, 28, 0x1A2B3C4D, 1, ~0U, ~0U, 28});  // a section
  for (const std::uint32_t link_type : {1U, 113U}) words({1, 20, link_type, 262144, 20});
  const ByteVector bytes = frame(plain_packet({}, 1, 0));
  const auto size = static_cast<std::uint32_t>(bytes.size());
  const std::uint32_t padded = (size + 3) / 4 * 4;
  words({6, 32 + padded, 0, 0, 1000, size, size});
  append(ng, bytes);
  ng.resize(ng.size() + padded - size);
  words({32 + padded});
  const std::string error = open_error("ouster:" + write_bytes(folder.path() + "/a.pcapng", ng) + meta);
  CHECK(error.find("a.pcapng: packet 1: ") != std::string::npos);
  CHECK(error.find("editcap -F pcap -T ether") != std::string::npos);
}

TEST_CASE("a recording that gives no sweep says why") {
  TemporaryFolder folder;
  const std::string meta = "?meta=" + write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  PcapWriter pcap(folder.path() + "/a.pcap");
  for (int id = 1; id <= 5; ++id) pcap.add(frame(plain_packet({}, id, 4)));
  pcap.add(frame(ByteVector(48)));
  auto source = open("ouster:" + pcap.write() + meta);
  CHECK(all_sweeps(*source).empty());
  REQUIRE(source->warnings().size() == 1);
  CHECK(source->warnings()[0].find("no sweep came of 6 packets: 5 sweeps of less than min_sweep_fraction of "
                                   "their columns, 1 packets that are not of such a sensor") == 0);
}
