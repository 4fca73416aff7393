#include <catch2/catch.hpp>

#include <algorithm>

#include "ipc/layout.hpp"
#include "ipc/messages.hpp"
#include "ipc/pools.hpp"

using namespace gvom;
using namespace gvom::ipc;

namespace {

std::size_t up_to_64(std::size_t bytes) {
  return (bytes + 63) / 64 * 64;
}

/// The pool that a message of `bytes` is served from.
Pool pool_for(const PoolPlan& plan, std::size_t bytes) {
  const auto fits = [bytes](const Pool& pool) { return pool.chunk_bytes >= bytes + 64; };
  return *std::find_if(plan.pools.begin(), plan.pools.end(), fits);
}

}  // namespace

TEST_CASE("arrays of a brick map follow each other, aligned") {
  const BrickMapLayout layout = brick_map_layout({7, 3, 5, 64});
  CHECK(layout.directory == up_to_64(sizeof(BrickMap)));
  CHECK(layout.lookup == layout.directory + 64);  // 7 * 4 bytes
  CHECK(layout.columns == layout.lookup + 3 * 2048);
  CHECK(layout.lowest_ray == layout.columns + 64);  // 3 * 8 bytes
  CHECK(layout.records == layout.lowest_ray + 64 * 4);
  CHECK(layout.bytes == layout.records + 5 * 12);
}

TEST_CASE("layers are ten float arrays and three byte arrays") {
  const LayersLayout layout = layers_layout(256);
  CHECK(layout.cells == 65536);
  CHECK(layout.bytes == up_to_64(sizeof(Layers)) + 65536 * (10 * 4 + 3));
  CHECK(layout.offset[1] - layout.offset[0] == 65536 * 4);
  CHECK(layout.offset[12] - layout.offset[11] == 65536);
  for (const std::size_t offset : layers_layout(24).offset) CHECK(offset % 64 == 0);
}

TEST_CASE("the paper's grid") {
  const PoolSpec spec;
  CHECK(brick_slots(spec) == 8192);
  CHECK(buffer_map_capacity(spec) ==
        up_to_64(sizeof(BrickMap)) + 8192 * (4 + 2048 + 8) + 65536 * 4 + 262144 * 12);
  // 8 maps of 262144 returns each can fill 2097152 of the 4194304 voxels.
  CHECK(voxel_map_capacity(spec) ==
        up_to_64(sizeof(BrickMap)) + 8192 * (4 + 2048 + 8) + 65536 * 4 + 2097152 * 12);
}

TEST_CASE("records are never more than voxels") {
  PoolSpec spec;
  spec.size_xy = spec.size_z = 8;
  CHECK(buffer_map_capacity(spec) == brick_map_bytes({1, 1, 512, 64}));
}

TEST_CASE("each topic has the chunks that its queues and holders can keep") {
  const PoolSpec spec;
  const auto plan = plan_pools(spec);
  REQUIRE(plan);
  // Publisher: 1 loaned, 1 last. Fusion: 16 queued, 8 + 1 held, 1. Spare: 4.
  CHECK(pool_for(*plan, buffer_map_capacity(spec)).chunks == 2 + (16 + 9 + 1) + 4);
  // Publisher: 1 loaned, 1 last, 1 history. Four planners: 2 queued, 2 held, 1. Spare: 4.
  CHECK(pool_for(*plan, layers_bytes(256)).chunks == 3 + 4 * (2 + 2 + 1) + 4);
  // Publisher: 1 loaned, 1 last. Four planners: 1 queued, 1 held, 1. Spare: 4.
  CHECK(pool_for(*plan, voxel_map_capacity(spec)).chunks == 2 + 4 * (1 + 1 + 1) + 4);
}

TEST_CASE("pools are as the bus wants them, for any vehicle") {
  for (const int size_xy : {8, 64, 256, 512}) {
    for (const int lidars : {1, 2, 5}) {
      PoolSpec spec;
      spec.size_xy = size_xy;
      spec.lidars = lidars;
      spec.max_returns = 20000;
      spec.max_planners = 2;
      const auto plan = plan_pools(spec);
      if (!plan) {
        CHECK(plan.error().kind == ErrorKind::too_large);
        continue;
      }
      std::uint64_t total = 0;
      std::uint32_t smaller = 0;
      for (const Pool& pool : plan->pools) {
        CHECK(pool.chunk_bytes % 8 == 0);
        CHECK(pool.chunk_bytes > smaller);
        const std::uint64_t bytes = std::uint64_t{pool.chunk_bytes} * pool.chunks;
        CHECK(bytes < (std::uint64_t{1} << 32));
        smaller = pool.chunk_bytes;
        total += bytes;
      }
      CHECK(plan->total_bytes == total);
    }
  }
}

TEST_CASE("messages of one size share a pool with the chunks of both") {
  PoolSpec spec;
  spec.buffer_size = 1;  // a voxel map is then as large as its only buffer map
  REQUIRE(voxel_map_capacity(spec) == buffer_map_capacity(spec));
  const auto plan = plan_pools(spec);
  REQUIRE(plan);
  CHECK(plan->pools.size() == 7);
  CHECK(plan->pools.back().chunks == (2 + 16 + 2 + 1) + (2 + 4 * 3) + 4);
}

TEST_CASE("without a voxel map there is no pool for it") {
  PoolSpec spec;
  spec.voxel_map = false;
  CHECK(plan_pools(spec)->pools.size() == 7);
  CHECK(plan_pools(spec)->pools.back().chunk_bytes < voxel_map_capacity(spec));
}

TEST_CASE("a pool of 4 GiB is refused, and the keys to lower are named") {
  PoolSpec spec;
  spec.lidars = 2;
  spec.buffer_size = 128;
  spec.voxel_map = false;
  const auto plan = plan_pools(spec);
  REQUIRE(!plan);
  CHECK(plan.error().kind == ErrorKind::too_large);
  CHECK_THAT(plan.error().message, Catch::Contains("buffer_map"));
  CHECK_THAT(plan.error().message, Catch::Contains("window.buffer_size"));
  CHECK_THAT(plan.error().message, Catch::Contains("4 GiB"));
}
