// Messages as gvomctl hears them, made for a test.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <utility>

#include "ipc/messages.hpp"
#include "ipc/text.hpp"

namespace gvom::test {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;
inline constexpr std::uint32_t kPid = 7;
inline constexpr char kVersion[] = "0.3.0";
inline constexpr std::uint64_t kConfigHash = 0x0123456789abcdef;

inline ipc::Health health_of(const char* process, ipc::HealthState state, std::int64_t mono_ns,
                             std::initializer_list<std::pair<const char*, std::uint64_t>> counters = {}) {
  ipc::Health health{};
  ipc::set_text(health.process, process);
  health.state = static_cast<std::uint32_t>(state);
  health.pid = kPid;
  health.rate_hz = 10.0;
  health.mono_ns = mono_ns;
  ipc::set_text(health.version, kVersion);
  health.config_hash = kConfigHash;
  for (const auto& [name, value] : counters) {
    ipc::set_text(health.counters[health.counter_count].name, name);
    health.counters[health.counter_count++].value = value;
  }
  return health;
}

/// Layers of the lidars front and rear, published at `mono_ns`, of packets from 30 ms before.
inline ipc::Layers layers_at(std::int64_t mono_ns) {
  ipc::Layers layers{};
  layers.header.stamp_ns = 100 * kSecond_ns;
  layers.mono_received_ns = mono_ns - 30'000'000;
  layers.mono_published_ns = mono_ns;
  layers.maps_in_window = 8;
  layers.lidar_count = 2;
  for (int i = 0; i < 2; ++i) {
    ipc::set_text(layers.lidars[i].name, i == 0 ? "front" : "rear");
    layers.lidars[i].newest_stamp_ns = layers.header.stamp_ns;
    layers.lidars[i].maps_in_window = 4;
    layers.lidars[i].columns_seen_fraction = 1;
  }
  return layers;
}

}  // namespace gvom::test
