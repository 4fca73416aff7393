#include "ipc/pool_use.hpp"

#include <utility>

#include "iceoryx_posh/popo/subscriber.hpp"
#include "iceoryx_posh/roudi/introspection_types.hpp"

namespace gvom::ipc {

struct PoolReports::State {
  iox::popo::Subscriber<iox::roudi::MemPoolIntrospectionInfoContainer> introspection{
      iox::roudi::IntrospectionMempoolService};
};

PoolReports::PoolReports(std::unique_ptr<State> state) : state_(std::move(state)) {}
PoolReports::PoolReports(PoolReports&&) noexcept = default;
PoolReports& PoolReports::operator=(PoolReports&&) noexcept = default;
PoolReports::~PoolReports() = default;

Expected<PoolReports> PoolReports::open(Runtime&) {
  return PoolReports(std::make_unique<State>());
}

std::optional<std::vector<PoolUse>> PoolReports::take() {
  std::optional<std::vector<PoolUse>> pools;
  auto& reports = state_->introspection;
  for (auto report = reports.take(); !report.has_error(); report = reports.take()) {
    if (report.value()->empty()) continue;
    pools.emplace();
    // The last segment is that of the payloads; the first is the broker's own.
    for (const auto& pool : report.value()->back().m_mempoolInfo)
      pools->push_back({pool.m_chunkPayloadSize, pool.m_numChunks, pool.m_usedChunks, pool.m_minFreeChunks});
  }
  return pools;
}

}  // namespace gvom::ipc
