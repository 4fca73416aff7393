// Who has read how far: what a lossless replay waits for.
#include <catch2/catch.hpp>

#include <cstring>

#include "services/odometry/rate.hpp"
#include "services/odometry/readers.hpp"

namespace {

using namespace gvom;
using odometry::Readers;
using Names = std::vector<std::string>;

constexpr std::uint64_t kEpoch = 1000;

/// An ingest's (or fusion's) message number `sequence`.
ipc::Progress progress_of(const char* reader, std::uint64_t sequence, std::uint64_t odometry = 0,
                          std::uint64_t maps = 0) {
  ipc::Progress progress{};
  std::strncpy(progress.reader, reader, sizeof(progress.reader) - 1);
  progress.header.sequence = sequence;
  progress.header.epoch = kEpoch;
  progress.odometry_sequence = odometry;
  progress.maps_published = maps;
  return progress;
}

ipc::Progress taken_by_fusion(std::uint64_t sequence, const char* lidar, std::uint64_t maps) {
  ipc::Progress progress = progress_of("fusion", sequence);
  progress.lidar_count = 1;
  std::strncpy(progress.taken[0].lidar, lidar, sizeof(progress.taken[0].lidar) - 1);
  progress.taken[0].sequence = maps;
  return progress;
}

}  // namespace

TEST_CASE("readers are missing until they announce themselves") {
  Readers readers({"front", "rear"}, kEpoch);
  CHECK(readers.missing() == Names{"front", "rear", "fusion"});
  readers.take(progress_of("rear", 1), 0, 1);
  readers.take(progress_of("stranger", 1), 0, 1);
  CHECK(readers.missing() == Names{"front", "fusion"});
  readers.take(progress_of("fusion", 1), 0, 1);
  readers.take(progress_of("front", 1), 0, 1);
  CHECK(readers.missing().empty());
}

TEST_CASE("the slowest ingest is the one that acknowledged least") {
  Readers readers({"front", "rear"}, kEpoch);
  CHECK(readers.slowest() == nullptr);
  readers.take(progress_of("front", 1, 5), 9, 1);
  readers.take(progress_of("rear", 1, 3), 9, 2);
  CHECK(readers.slowest()->name == "rear");
  CHECK(readers.slowest()->acknowledged == 3);
  readers.take(progress_of("rear", 2, 8), 9, 3);
  CHECK(readers.slowest()->name == "front");
  CHECK(readers.last_advance_ns() == 3);
}

TEST_CASE("a heartbeat without news is no progress") {
  Readers readers({"top"}, kEpoch);
  readers.take(progress_of("top", 1, 4), 9, 100);
  readers.take(progress_of("top", 2, 4), 9, 200);
  CHECK(readers.last_advance_ns() == 100);
  readers.take(progress_of("top", 3, 4, 1), 9, 300);
  CHECK(readers.last_advance_ns() == 300);
}

TEST_CASE("what a reader says of an earlier gvom-odometry does not count") {
  Readers readers({"top"}, kEpoch);
  ipc::Progress old = progress_of("top", 70, 150);
  old.header.epoch = kEpoch - 1;
  readers.take(old, 0, 1);
  CHECK(readers.missing() == Names{"fusion"});
  CHECK(readers.slowest()->acknowledged == 0);
  readers.take(progress_of("top", 71, 1), 1, 2);
  CHECK(readers.slowest()->acknowledged == 1);
}

TEST_CASE("a reader cannot have read what is not published") {
  Readers readers({"top"}, kEpoch);
  readers.take(progress_of("top", 1, 99), 10, 1);
  CHECK(readers.slowest()->acknowledged == 10);
}

TEST_CASE("a reader that began anew is not waited for with what it can never get") {
  Readers readers({"top"}, kEpoch);
  CHECK(readers.take(progress_of("top", 50, 40), 60, 1) == nullptr);
  const odometry::Reader* const restarted = readers.take(progress_of("top", 1, 0), 60, 2);
  REQUIRE(restarted != nullptr);
  CHECK(restarted->restarts == 1);
  CHECK(readers.slowest()->acknowledged == 60);
  CHECK(readers.take(progress_of("top", 2, 61), 61, 3) == nullptr);
  CHECK(readers.slowest()->acknowledged == 61);
}

TEST_CASE("a fusion that began anew is not waited for with the maps that it can never get") {
  Readers readers({"top"}, kEpoch);
  readers.take(progress_of("top", 1, 5, 10), 5, 1);
  readers.take(taken_by_fusion(7, "top", 8), 5, 1);
  CHECK(readers.outstanding(5) == Names{"fusion took 8 of 10 maps of 'top'"});
  readers.take(progress_of("fusion", 1), 5, 2);
  // The ingest made maps that it has not told of: only its next word says which of them fusion can not get.
  CHECK(readers.outstanding(5) == Names{"'top' has yet to say which maps it made before fusion began anew"});
  readers.take(progress_of("top", 2, 5, 12), 5, 3);
  CHECK(readers.outstanding(5).empty());
  readers.take(progress_of("top", 3, 5, 13), 5, 4);
  CHECK(readers.outstanding(5) == Names{"fusion took 12 of 13 maps of 'top'"});
  readers.take(taken_by_fusion(2, "top", 13), 5, 5);
  CHECK(readers.outstanding(5).empty());
}

TEST_CASE("an ingest that comes after a fusion that began anew has all its maps waited for") {
  Readers readers({"first", "anew"}, kEpoch);
  readers.take(progress_of("anew", 8, 5, 10), 5, 1);
  readers.take(progress_of("fusion", 7), 5, 1);
  readers.take(progress_of("fusion", 1), 5, 2);
  readers.take(progress_of("first", 1, 5, 2), 5, 3);
  readers.take(progress_of("anew", 1, 5, 3), 5, 3);
  CHECK(readers.outstanding(5) ==
        Names{"fusion took 0 of 2 maps of 'first'", "fusion took 0 of 3 maps of 'anew'"});
}

TEST_CASE("once a fusion that began anew takes maps, the later ones are waited for, told or not") {
  Readers readers({"top"}, kEpoch);
  readers.take(progress_of("top", 1, 5, 10), 5, 1);
  readers.take(taken_by_fusion(7, "top", 8), 5, 1);
  readers.take(taken_by_fusion(1, "top", 12), 5, 2);
  readers.take(progress_of("top", 2, 5, 14), 5, 3);
  CHECK(readers.outstanding(5) == Names{"fusion took 12 of 14 maps of 'top'"});
}

TEST_CASE("who has fallen silent can be left out") {
  Readers readers({"front", "rear"}, kEpoch);
  readers.take(progress_of("front", 1, 4), 5, 100);
  readers.take(progress_of("rear", 1, 4, 1), 5, 200);
  readers.take(taken_by_fusion(1, "rear", 0), 5, 150);
  CHECK(readers.outstanding(5).size() == 3);
  CHECK(readers.outstanding(5, 150) ==
        Names{"'rear' is at odometry 4 of 5", "fusion took 0 of 1 maps of 'rear'"});
  CHECK(readers.outstanding(5, 151) == Names{"'rear' is at odometry 4 of 5"});
  CHECK(readers.outstanding(5, 201).empty());
}

TEST_CASE("the end is reached when ingests have read it and fusion took their maps") {
  Readers readers({"top"}, kEpoch);
  CHECK(readers.outstanding(5).empty());  // nobody there, nobody to wait for
  readers.take(progress_of("top", 1, 4, 3), 5, 1);
  readers.take(taken_by_fusion(1, "top", 2), 5, 1);
  CHECK(readers.outstanding(5) == Names{"'top' is at odometry 4 of 5", "fusion took 2 of 3 maps of 'top'"});
  readers.take(progress_of("top", 2, 5, 4), 5, 1);
  CHECK(readers.outstanding(5) == Names{"fusion took 2 of 4 maps of 'top'"});
  readers.take(taken_by_fusion(2, "top", 4), 5, 1);
  CHECK(readers.outstanding(5).empty());
  CHECK(readers.maps_published() == 4);
}

TEST_CASE("a rate is a number above 0, or max") {
  CHECK(odometry::parse_rate("2.5")->factor == 2.5);
  CHECK_FALSE(odometry::parse_rate("2.5")->lossless);
  CHECK(odometry::parse_rate("max")->lossless);
  for (const char* text : {"", "0", "-1", "nan", "inf", "fast", "1x", "1001"}) {
    INFO(text);
    CHECK_FALSE(odometry::parse_rate(text));
  }
}
