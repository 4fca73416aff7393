#include "tests/systemd/bus_log.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace gvom::test {

using namespace std::chrono_literals;

void Stream::note(std::int64_t published_ns) {
  if (newest_ns != 0) longest_gap_ns = std::max(longest_gap_ns, published_ns - newest_ns);
  newest_ns = published_ns;
}

std::int64_t Stream::gap_ns(std::int64_t now_ns) const {
  return std::max(longest_gap_ns, now_ns - newest_ns);
}

BusLog::BusLog(ipc::LayersSubscriber layers_in, ipc::Subscriber<ipc::Health> health_in,
               ipc::PoolReports pools_in, ipc::Waiter waiter)
    : layers_in_(std::move(layers_in)),
      health_in_(std::move(health_in)),
      pools_in_(std::move(pools_in)),
      waiter_(std::move(waiter)) {}

ipc::Expected<BusLog> BusLog::open(ipc::Runtime& runtime, const std::vector<std::string>& lidars) {
  auto layers = ipc::LayersSubscriber::open(runtime);
  if (!layers) return tl::unexpected(layers.error());
  auto health = ipc::Subscriber<ipc::Health>::open(runtime);
  if (!health) return tl::unexpected(health.error());
  auto pools = ipc::PoolReports::open(runtime);
  if (!pools) return tl::unexpected(pools.error());
  BusLog log(std::move(*layers), std::move(*health), std::move(*pools), ipc::Waiter::create(runtime));
  log.waiter_.add(log.layers_in_);
  for (const std::string& name : lidars) {
    auto maps = ipc::BrickMapSubscriber::buffer_map(runtime, name);
    if (!maps) return tl::unexpected(maps.error());
    log.waiter_.add(*maps);
    log.lidars.push_back({name, std::move(*maps), {}});
  }
  return log;
}

void BusLog::pump() {
  waiter_.wait(20ms);
  const std::int64_t now_ns = ipc::monotonic_ns();
  for (Lidar& lidar : lidars) {
    while (const auto map = lidar.subscriber.take()) lidar.maps.note(map->header().mono_published_ns);
  }
  note_layers(now_ns);
  while (const auto health = health_in_.take()) {
    const bool ok = (*health)->state == static_cast<std::uint32_t>(ipc::HealthState::ok);
    processes[(*health)->process] = {static_cast<pid_t>((*health)->pid), ok, now_ns};
  }
  note_pools();
}

void BusLog::note_layers(std::int64_t now_ns) {
  while (const auto sample = layers_in_.take()) {
    newest = sample->header();
    layers.note(newest.mono_published_ns);
    for (Lidar& one : lidars) {
      const ipc::LidarStatus* status = lidar(one.name);
      if (status == nullptr) continue;
      if (status->missing != 0 && one.named_missing_ns == 0) one.named_missing_ns = now_ns;
      one.fewest_maps = std::min(one.fewest_maps, status->maps_in_window);
    }
  }
}

void BusLog::note_pools() {
  const auto report = pools_in_.take();
  if (!report) return;
  if (pool_reports++ == 0) used_chunks.assign(report->size(), std::numeric_limits<std::uint32_t>::max());
  for (std::size_t i = 0; i < report->size(); ++i)
    used_chunks[i] = std::min(used_chunks[i], (*report)[i].used);
}

void BusLog::begin_anew() {
  layers.begin_anew();
  for (Lidar& lidar : lidars) {
    lidar.maps.begin_anew();
    lidar.named_missing_ns = 0;
    lidar.fewest_maps = std::numeric_limits<std::uint32_t>::max();
  }
}

const ipc::LidarStatus* BusLog::lidar(const std::string& name) const {
  for (std::uint32_t i = 0; i < newest.lidar_count; ++i)
    if (name == newest.lidars[i].name) return &newest.lidars[i];
  return nullptr;
}

bool BusLog::is_full(std::uint32_t maps_of_each) const {
  const auto* const end = newest.lidars + newest.lidar_count;
  return newest.lidar_count > 0 && std::all_of(newest.lidars, end, [&](const ipc::LidarStatus& lidar) {
           return lidar.maps_in_window >= maps_of_each && lidar.missing == 0;
         });
}

}  // namespace gvom::test
