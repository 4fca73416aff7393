// How full the broker's pools are.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "ipc/runtime.hpp"

namespace gvom::ipc {

/// One pool of the payloads.
struct PoolUse {
  std::uint32_t chunk_bytes;  ///< That a message in it can have.
  std::uint32_t chunks;
  std::uint32_t used;
  std::uint32_t min_free;  ///< The fewest that were free since the broker started.
};

/// The broker's own reports, once a second.
class PoolReports {
 public:
  static Expected<PoolReports> open(Runtime& runtime);
  PoolReports(PoolReports&&) noexcept;
  PoolReports& operator=(PoolReports&&) noexcept;
  ~PoolReports();

  /// The newest report that was not taken yet: each pool, by size.
  std::optional<std::vector<PoolUse>> take();

 private:
  struct State;
  explicit PoolReports(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace gvom::ipc
