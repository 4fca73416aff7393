// Captures in part, packed, of several sensors or interfaces: what is read of them, and what is said.
#include <zlib.h>

#include <fstream>
#include <random>

#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using namespace gvom::ingest;

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
