// How many chunks of the broker's pools are in use, from its introspection (once a second).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "iceoryx_posh/popo/subscriber.hpp"
#include "iceoryx_posh/roudi/introspection_types.hpp"

namespace gvom::ipc::test {

/// In a process that has joined.
class PoolUse {
 public:
  PoolUse() : introspection_(iox::roudi::IntrospectionMempoolService) {}

  /// The newest report that was not taken yet: for each payload pool, by size, the chunks in use.
  std::optional<std::vector<std::uint32_t>> take() {
    std::optional<std::vector<std::uint32_t>> used;
    for (auto report = introspection_.take(); !report.has_error(); report = introspection_.take()) {
      used.emplace();
      // The last segment is that of the payloads; the first is the broker's own.
      for (const auto& pool : report.value()->back().m_mempoolInfo) used->push_back(pool.m_usedChunks);
    }
    return used;
  }

 private:
  iox::popo::Subscriber<iox::roudi::MemPoolIntrospectionInfoContainer> introspection_;
};

}  // namespace gvom::ipc::test
