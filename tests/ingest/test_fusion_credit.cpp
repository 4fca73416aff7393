// How many maps ingest may publish ahead of fusion in a lossless replay.
#include <catch2/catch.hpp>

#include <cstring>
#include <memory>

#include "services/ingest/fusion_credit.hpp"

using namespace gvom;
using ingest::FusionCredit;

namespace {

std::unique_ptr<ipc::Progress> progress_of(std::uint64_t sequence, std::uint64_t taken) {
  auto progress = std::make_unique<ipc::Progress>();
  progress->header.sequence = sequence;
  ipc::set_text(progress->reader, "fusion");
  progress->lidar_count = 1;
  ipc::set_text(progress->taken[0].lidar, "front");
  progress->taken[0].sequence = taken;
  return progress;
}

}  // namespace

TEST_CASE("fusion has room for a few maps more than it has taken, or than were there when it began anew") {
  FusionCredit credit("front");
  CHECK(credit.has_room(3));
  CHECK_FALSE(credit.has_room(4));
  credit.take(*progress_of(1, 4), 4);
  CHECK(credit.has_room(7));
  CHECK_FALSE(credit.has_room(8));
  credit.take(*progress_of(1, 0), 8);
  CHECK(credit.has_room(11));
}

TEST_CASE("names without an end are read no further than their field") {
  FusionCredit credit("front");
  const auto progress = progress_of(1, 9);
  progress->lidar_count = kMaxLidars;
  for (auto& taken : progress->taken) std::memset(&taken, 'x', sizeof taken);
  credit.take(*progress, 4);
  CHECK_FALSE(credit.has_room(4));
  std::memset(progress->reader, 'x', sizeof progress->reader);
  credit.take(*progress, 4);
  CHECK_FALSE(credit.has_room(4));
}
