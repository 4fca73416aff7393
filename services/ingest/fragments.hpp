// Reassembly of fragmented IP datagrams, bounded in memory.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/ingest/packet.hpp"

namespace gvom::ingest {

struct Fragment {
  Address source{};
  Address destination{};
  std::uint32_t id = 0;
  std::size_t offset = 0;  ///< In the datagram's payload, a multiple of 8.
  bool more = false;       ///< Not the last one.
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
  std::int64_t capture_ns = 0;
};

struct Bytes {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// Counts `fragments` and `lost_fragments` (datagrams given up).
class FragmentTable {
 public:
  explicit FragmentTable(SourceCounters& counters);

  /// The whole payload when `fragment` was the last one missing, else null data. Valid until the next call.
  Bytes add(const Fragment& fragment);

  /// Gives up every open datagram.
  void clear();

  /// Datagrams given up with their first fragment alone, if never another one came: what a filter by port
  /// leaves, for the others have no port.
  [[nodiscard]] std::uint64_t lonely() const { return any_other_ ? 0 : lonely_; }

 private:
  static constexpr std::size_t kOpenDatagrams = 8;
  static constexpr std::size_t kMaxBytes = 65536;
  static constexpr std::int64_t kMaxAgeNs = 1'000'000'000;

  struct Slot {
    bool open = false;
    Fragment key;
    std::uint64_t order = 0;
    std::size_t total = 0;     // 0: the last fragment has not come
    std::size_t end = 0;       // of the furthest byte so far
    std::size_t received = 0;  // distinct bytes
    std::bitset<kMaxBytes / 8> units;
    std::vector<std::uint8_t> bytes;
  };

  Slot& slot_of(const Fragment& fragment);
  void give_up(Slot& slot);
  static void store(Slot& slot, const Fragment& fragment);

  SourceCounters& counters_;
  std::array<Slot, kOpenDatagrams> slots_;
  std::uint64_t order_ = 0;
  std::uint64_t lonely_ = 0;
  bool any_other_ = false;  // a fragment that is not its datagram's first
};

}  // namespace gvom::ingest
