// Buffer maps and voxel maps: written straight into the chunk that travels, read where they lie.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "ipc/layout.hpp"
#include "ipc/port.hpp"
#include "ipc/span.hpp"

namespace gvom::ipc {

/// A map being written. Its arrays hold old data until written; the header is zero but for the counts.
/// Destroyed without having been published, it gives its chunk back.
class BrickMapWriter {
 public:
  [[nodiscard]] BrickMap& header() const { return *reinterpret_cast<BrickMap*>(loan_.data()); }
  [[nodiscard]] Span<std::int32_t> directory() const;  ///< brick_slots
  [[nodiscard]] Span<std::int32_t> lookup() const;     ///< brick_count * 512
  [[nodiscard]] Span<std::uint64_t> columns() const;   ///< brick_count
  [[nodiscard]] Span<VoxelRecord> records() const;     ///< record_count
  [[nodiscard]] Span<float> lowest_ray_m() const;      ///< column_count
  [[nodiscard]] BrickMapArrays arrays() const;         ///< All five.

 private:
  friend class BrickMapPublisher;
  BrickMapWriter(Loan loan, const BrickMapLayout& layout) : loan_(std::move(loan)), layout_(layout) {}
  Loan loan_;
  BrickMapLayout layout_;
};

class BrickMapPublisher {
 public:
  /// `capacity_bytes`: buffer_map_capacity() of the vehicle's PoolSpec. Errors: bad_name.
  static Expected<BrickMapPublisher> buffer_map(Runtime& runtime, const std::string& lidar,
                                                std::size_t capacity_bytes);
  /// `capacity_bytes`: voxel_map_capacity() of the vehicle's PoolSpec.
  static Expected<BrickMapPublisher> voxel_map(Runtime& runtime, std::size_t capacity_bytes);

  /// Errors: too_large (beyond the capacity, or the broker's pools are of another configuration), exhausted.
  Expected<BrickMapWriter> loan(const BrickMapShape& shape);

  /// Stamps mono_published_ns and sends; returns the sequence number.
  std::uint64_t publish(BrickMapWriter&& writer, std::int64_t stamp_ns, std::uint64_t epoch);

  [[nodiscard]] bool has_subscribers() const { return port_.has_subscribers(); }
  [[nodiscard]] std::uint64_t sequence() const { return port_.sequence(); }

 private:
  BrickMapPublisher(OutPort port, std::string lidar, std::size_t capacity_bytes);
  OutPort port_;
  std::string lidar_;
  std::size_t capacity_bytes_;
};

/// What is wrong with a map's arrays.
struct MapFault {
  enum class Part { directory, lookup, columns, lowest_ray, records };
  Part part;
  std::string why;  ///< In words.
};

/// A received map. Its counts, sizes and offsets fit its chunk; what the arrays hold is checked by
/// validate_deep().
class BrickMapSample {
 public:
  explicit BrickMapSample(Chunk chunk);

  [[nodiscard]] const BrickMap& header() const { return *reinterpret_cast<const BrickMap*>(chunk_.data()); }
  [[nodiscard]] Span<const std::int32_t> directory() const;
  [[nodiscard]] Span<const std::int32_t> lookup() const;
  [[nodiscard]] Span<const std::uint64_t> columns() const;
  [[nodiscard]] Span<const float> lowest_ray_m() const;
  [[nodiscard]] Span<const VoxelRecord> records() const;
  /// The map with its arrays, to be read where it lies: while this sample lives.
  [[nodiscard]] BrickMapView view() const;

  /// Nothing if the arrays are what a map's can be: the directory names each brick once, in the order of
  /// their slots; as many voxels as there are records lead to one, each to one that is there; the columns
  /// have bits where a voxel was observed; every record has hits, at a height that can be. Reads all of
  /// that once, some 0.1 ms for a sweep: call it before you follow an index.
  [[nodiscard]] tl::expected<void, MapFault> validate_deep() const;

 private:
  Chunk chunk_;
  BrickMapLayout layout_;
};

class BrickMapSubscriber {
 public:
  static Expected<BrickMapSubscriber> buffer_map(Runtime& runtime, const std::string& lidar);
  static Expected<BrickMapSubscriber> voxel_map(Runtime& runtime);

  /// The oldest unread map. Up to 240 samples may be held at a time.
  std::optional<BrickMapSample> take();

  [[nodiscard]] bool has_data() const { return port_.has_data(); }
  [[nodiscard]] const InCounters& counters() const { return port_.counters(); }
  std::optional<std::string> new_refusal() { return port_.new_refusal(); }
  [[nodiscard]] const std::string& newest_refusal() const { return port_.newest_refusal(); }
  InPort& port() { return port_; }

 private:
  explicit BrickMapSubscriber(InPort port) : port_(std::move(port)) {}
  InPort port_;
};

}  // namespace gvom::ipc
