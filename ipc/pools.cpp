#include "ipc/pools.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

#include "ipc/layout.hpp"
#include "ipc/topic.hpp"

namespace gvom::ipc {
namespace {

constexpr std::uint64_t kPoolLimitBytes = std::uint64_t{1} << 32;
constexpr std::uint64_t kSlackBytes = 256;     // chunk header's share, alignment to 64, rounding to 8
constexpr std::uint64_t kSpareChunks = 4;      // of each pool
constexpr std::uint64_t kPublisherChunks = 2;  // one loaned, the last one sent
constexpr std::uint64_t kOtherReaders = 4;     // recorder, bridge, gvomctl and one more
constexpr std::uint64_t kOtherProcesses = 8;   // odometry, fusion, broker, tools: all publish Health
constexpr std::uint64_t kHeldFixed = 2;        // messages of fixed size that a reader holds
constexpr std::uint64_t kPlanTalkers = 2;      // that publish a course, a plan or commands at the same time
constexpr std::uint64_t kHeldByPlanner = 2;    // the layers it works on and the next ones

/// What one topic asks of the pools.
struct Demand {
  std::string topics;
  std::string keys;  // to lower if it does not fit
  std::uint64_t bytes;
  std::uint64_t chunks;
};

std::uint64_t reader_chunks(std::uint64_t queue, std::uint64_t held) {
  return queue + held + 1;
}

std::uint64_t planning_chunks(std::uint64_t planners, std::uint64_t queue) {
  return kPlanTalkers * (kPublisherChunks + kPlannerHistory) +
         (planners + kOtherReaders) * reader_chunks(queue, kHeldFixed);
}

std::vector<Demand> fixed_demands(const PoolSpec& spec) {
  const std::uint64_t lidars = spec.lidars;
  const std::uint64_t planners = spec.max_planners;
  const std::string keys = "ipc.max_planners";
  return {{"odometry", keys, sizeof(Odometry),
           2 * kPublisherChunks +
               (lidars + planners + kOtherReaders) * reader_chunks(kOdometryQueue, kHeldFixed) +
               reader_chunks(1, kHeldFixed)},  // fusion wants the newest alone
          {"progress", keys, sizeof(Progress),
           (lidars + 1) * kPublisherChunks +
               (lidars + 2 + kOtherReaders) * reader_chunks(kProgressQueue, kHeldFixed)},
          {"health", keys, sizeof(Health),
           (lidars + planners + kOtherProcesses) * kPublisherChunks +
               (planners + kOtherReaders) * reader_chunks(kHealthQueue, kHeldFixed)},
          {"course", keys, sizeof(Course), planning_chunks(planners, kCourseQueue)},
          {"plan", keys, sizeof(Plan), planning_chunks(planners, kPlanQueue)},
          {"command", keys, sizeof(Command), planning_chunks(planners, kCommandQueue)}};
}

std::vector<Demand> map_demands(const PoolSpec& spec) {
  const std::uint64_t planners = spec.max_planners;
  // Fusion takes the newest map before it lets the oldest go.
  const std::uint64_t held_by_fusion = static_cast<std::uint64_t>(spec.buffer_size) + 1;
  std::vector<Demand> demands = {
      {"layers", "map.size_xy or ipc.max_planners", layers_bytes(spec.size_xy),
       kPublisherChunks + kLayersHistory + planners * reader_chunks(kLayersQueue, kHeldByPlanner)},
      {"buffer_map", "window.buffer_size, map.size_xy, map.size_z or lidars.*.max_returns",
       buffer_map_capacity(spec),
       spec.lidars * (kPublisherChunks + reader_chunks(kBufferMapQueue, held_by_fusion))}};
  if (spec.voxel_map) {
    demands.push_back(
        {"voxel_map", "ipc.max_planners, map.size_xy or map.size_z (or fusion.voxel_rate_hz to 0)",
         voxel_map_capacity(spec), kPublisherChunks + planners * reader_chunks(kVoxelMapQueue, 1)});
  }
  return demands;
}

std::uint64_t pool_bytes(const Demand& demand) {
  return (demand.bytes + kSlackBytes + 7) / 8 * 8;
}

/// One demand for each pool, by size. A message that would fit the pool below its own would be served from
/// there, so the two share one.
std::vector<Demand> merged(std::vector<Demand> demands) {
  std::sort(demands.begin(), demands.end(),
            [](const Demand& a, const Demand& b) { return a.bytes < b.bytes; });
  std::vector<Demand> result;
  for (const Demand& demand : demands) {
    if (result.empty() || demand.bytes > pool_bytes(result.back())) {
      result.push_back(demand);
      continue;
    }
    Demand& shared = result.back();
    shared.topics += " and " + demand.topics;
    if (shared.keys != demand.keys) shared.keys += "; " + demand.keys;
    shared.bytes = demand.bytes;
    shared.chunks += demand.chunks;
  }
  return result;
}

Error pool_too_large(const Demand& demand) {
  char numbers[160];
  std::snprintf(numbers, sizeof(numbers), "%llu chunks of %.1f MB are %.2f GiB",
                static_cast<unsigned long long>(demand.chunks), static_cast<double>(demand.bytes) * 1e-6,
                static_cast<double>(demand.chunks * pool_bytes(demand)) / static_cast<double>(1 << 30));
  return {ErrorKind::too_large, "the shared-memory pool of " + demand.topics + " does not fit: " + numbers +
                                    ", a pool must stay under 4 GiB; lower " + demand.keys};
}

std::uint64_t voxels(const PoolSpec& spec) {
  return brick_slots(spec) * std::uint64_t{kBrickCells};
}

std::size_t capacity(const PoolSpec& spec, std::uint64_t most_records) {
  const std::uint64_t records = std::min(voxels(spec), most_records);
  const std::uint32_t slots = brick_slots(spec);
  return brick_map_bytes({slots, slots, static_cast<std::uint32_t>(records), columns(spec)});
}

}  // namespace

std::uint32_t columns(const PoolSpec& spec) {
  return static_cast<std::uint32_t>(spec.size_xy) * static_cast<std::uint32_t>(spec.size_xy);
}

std::uint32_t brick_slots(const PoolSpec& spec) {
  const int bricks_xy = spec.size_xy / kBrickEdge;
  return static_cast<std::uint32_t>(bricks_xy * bricks_xy * (spec.size_z / kBrickEdge));
}

std::size_t buffer_map_capacity(const PoolSpec& spec) {
  return capacity(spec, static_cast<std::uint64_t>(spec.max_returns));
}

std::size_t voxel_map_capacity(const PoolSpec& spec) {
  const std::uint64_t maps =
      static_cast<std::uint64_t>(spec.lidars) * static_cast<std::uint64_t>(spec.buffer_size);
  return capacity(spec, maps * static_cast<std::uint64_t>(spec.max_returns));
}

Expected<PoolPlan> plan_pools(const PoolSpec& spec) {
  std::vector<Demand> demands = fixed_demands(spec);
  for (Demand& demand : map_demands(spec)) demands.push_back(std::move(demand));
  PoolPlan plan{{}, 0};
  for (Demand& demand : merged(std::move(demands))) {
    demand.chunks += kSpareChunks;
    const std::uint64_t total = demand.chunks * pool_bytes(demand);
    if (total >= kPoolLimitBytes) return tl::unexpected(pool_too_large(demand));
    plan.pools.push_back(
        {static_cast<std::uint32_t>(pool_bytes(demand)), static_cast<std::uint32_t>(demand.chunks)});
    plan.total_bytes += total;
  }
  return plan;
}

}  // namespace gvom::ipc
