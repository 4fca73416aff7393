// After the first few sweeps a source allocates nothing: operator new is counted.
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using gvom::ingest::SourceEvent;

namespace {
std::atomic<std::size_t> allocations{0};
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace {

/// Allocations from the third sweep to the last but one (at the end of a recording a file is closed).
std::size_t steady_allocations(const std::string& uri, std::size_t sweeps) {
  auto source = open(uri);
  Sweep sweep;
  std::size_t before = 0;
  for (std::size_t i = 0; i < sweeps; ++i) {
    if (i == 2) before = allocations;
    REQUIRE(source->next(sweep, std::chrono::milliseconds(0)).value() == SourceEvent::kSweep);
  }
  return allocations - before;
}

}  // namespace

TEST_CASE("Ouster packets, whole and in fragments, are decoded without allocating") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  PcapWriter pcap(folder.path() + "/a.pcap");
  std::uint16_t id = 0;
  for (int i = 0; i < 1000; ++i) {
    for (int column = 0; column < 16; column += 4) {
      const ByteVector payload = plain_packet({}, i, column);
      if (column == 8) pcap.add(frame(ByteVector(48)));
      if (column != 4) pcap.add(frame(payload));
      if (column != 4) continue;
      for (const auto& part : fragments(payload, 64, {1, 7502, ++id})) pcap.add(part);
    }
  }
  CHECK(steady_allocations("ouster:" + pcap.write() + "?meta=" + meta, 1000) == 0);
}

TEST_CASE("Velodyne packets are decoded without allocating") {
  TemporaryFolder folder;
  PcapWriter pcap(folder.path() + "/a.pcap");
  for (int i = 0; i < 3600; ++i) {
    ByteVector packet(1206);
    for (int block = 0; block < 12; ++block) {
      const auto azimuth = static_cast<std::uint16_t>((i * 12 + block) * 90 % 36000);  // 33.3 packets a turn
      const std::size_t at = static_cast<std::size_t>(block) * 100;
      packet[at] = 0xFF;
      packet[at + 1] = 0xEE;
      std::memcpy(&packet[at + 2], &azimuth, 2);
      packet[at + 4] = 100;
    }
    const auto time_us = static_cast<std::uint32_t>(i * 12 * 110.592);
    std::memcpy(&packet[1200], &time_us, 4);
    packet[1204] = 0x37;
    packet[1205] = 0x22;
    pcap.add(frame(packet));
  }
  CHECK(steady_allocations("velodyne:" + pcap.write() + "?model=VLP-16", 100) == 0);
}

TEST_CASE(".bin files are read without allocating") {
  TemporaryFolder folder;
  for (int i = 0; i < 100; ++i) {
    write_text(folder.path() + "/" + std::to_string(1000 + i) + ".bin",
               std::string(16 * static_cast<std::size_t>(1000 + i), '\0'));
  }
  CHECK(steady_allocations("scans:" + folder.path(), 100) == 0);
}
