// Whatever the bytes are: no crash, no sanitizer report, and everything that is handed out hangs together.
#include <random>

#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using gvom::ingest::SourceEvent;
using namespace std::string_literals;

namespace {

/// What was tried: a test of input that is all refused at once has tried nothing.
struct Tried {
  int opened = 0, sweeps = 0;
};

void drain(const std::string& uri, Tried& tried) {
  auto source = ingest::open_source(uri, {0.0, 5000});
  if (!source) return;
  ++tried.opened;
  Sweep sweep;
  for (;;) {
    const auto event = (*source)->next(sweep, std::chrono::milliseconds(0));
    if (!event || *event == SourceEvent::kEnd) return;
    ++tried.sweeps;
    REQUIRE(sweep.returns.size() <= 5000);
    REQUIRE_FALSE(sweep.times_ns.empty());
    for (const Return& r : sweep.returns) REQUIRE(r.time_index < sweep.times_ns.size());
  }
}

ByteVector damaged(ByteVector bytes, std::mt19937& random, std::size_t from, int count) {
  for (int i = 0; i < count; ++i) {
    const std::size_t at = from + random() % (bytes.size() - from);
    bytes[at] = static_cast<std::uint8_t>(random());
  }
  return bytes;
}

/// Frames with a valid way to the payload, the payload damaged; and frames damaged anywhere.
void try_payloads(const ByteVector& payload, const std::string& options, const std::string& scheme) {
  Tried tried;
  std::mt19937 random(7);
  TemporaryFolder folder;
  for (int round = 0; round < 20; ++round) {
    PcapWriter pcap(folder.path() + "/damaged.pcap");
    pcap.add(frame(payload));
    for (int i = 0; i < 100; ++i) {
      pcap.add(frame(damaged(payload, random, 0, 1 + i)));
      pcap.add(damaged(frame(payload), random, 0, 4));
      for (const auto& part : fragments(payload, 400)) pcap.add(damaged(part, random, 14, 1));
    }
    drain(scheme + ":" + pcap.write() + options, tried);
  }
  CAPTURE(scheme, options);
  CHECK(tried.opened == 20);
  CHECK(tried.sweeps > 0);
}

}  // namespace

TEST_CASE("damaged Ouster packets") {
  for (const char* profile :
       {"LEGACY", "RNG15_RFL8_NIR8", "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL",
        "FUSA_RNG15_RFL8_NIR8_DUAL", "RNG19_RFL8_SIG16_NIR16_RGB16_DUAL"}) {
    TemporaryFolder folder;
    OusterSensor sensor;
    sensor.profile = profile;
    const std::string meta = write_text(folder.path() + "/meta.json", sensor.json());
    try_payloads(plain_packet(sensor, 1, 4), "?meta=" + meta, "ouster");
  }
}

TEST_CASE("damaged Velodyne packets") {
  std::mt19937 random(3);
  ByteVector packet(1206);
  for (auto& byte : packet) byte = static_cast<std::uint8_t>(random());
  for (std::size_t block = 0; block < 12; ++block) {
    packet[block * 100] = 0xFF;
    packet[block * 100 + 1] = 0xEE;
    packet[block * 100 + 3] = static_cast<std::uint8_t>(block);
  }
  packet[1203] = 0;
  packet[1204] = 0x37;
  packet[1205] = 0x22;
  for (const char* model : {"VLP-16", "VLP-32C&model_byte=0x22", "HDL-32&model_byte=0x22"}) {
    try_payloads(packet, std::string("?model=") + model, "velodyne");
  }
  for (std::size_t block = 0; block < 12; ++block)
    packet[block * 100 + 1] = static_cast<std::uint8_t>(0xEE - 0x11 * (block % 4));
  try_payloads(packet, "?model=VLS-128&model_byte=0x22", "velodyne");
}

TEST_CASE("damaged captures, metadata and point clouds") {
  Tried captures, metadata, clouds;
  std::mt19937 random(5);
  TemporaryFolder folder;
  const OusterSensor sensor;
  const std::string meta = write_text(folder.path() + "/meta.json", sensor.json());
  PcapWriter pcap(folder.path() + "/a.pcap");
  for (int i = 0; i < 16; ++i) pcap.add(frame(plain_packet(sensor, i / 4, i % 4 * 4)));
  std::ifstream file(pcap.write(), std::ios::binary);
  const ByteVector capture{std::istreambuf_iterator<char>(file), {}};
  const std::string json = sensor.json();
  const std::string cloud =
      "VERSION 0.7\nFIELDS x y z t\nSIZE 4 4 4 8\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS "
      "2\nDATA ";
  const auto write = [&](const std::string& name, const ByteVector& bytes) {
    return write_text(folder.path() + name, std::string(bytes.begin(), bytes.end()));
  };
  for (int round = 0; round < 500; ++round) {
    drain("ouster:" + write("/b.pcap", damaged(capture, random, 0, 3)) + "?meta=" + meta, captures);
    const std::string other = write("/b.json", damaged(ByteVector(json.begin(), json.end()), random, 0, 2));
    drain("ouster:" + folder.path() + "/a.pcap?meta=" + other, metadata);
    for (const std::string& data :
         {"ascii\n1 2 3 4\n5 6 7 8\n"s, "binary\n0123456789012345678901234567890123456789"s,
          "binary_compressed\n\x10\0\0\0\x28\0\0\0aaaaaaaaaaaaaaaa"s}) {
      const std::string text = cloud + data;
      drain("scans:" + write("/b.pcd", damaged(ByteVector(text.begin(), text.end()), random, 0, 2)), clouds);
    }
  }
  for (const Tried& tried : {captures, metadata, clouds}) {
    CHECK(tried.opened > 0);
    CHECK(tried.sweeps > 0);
  }
}
