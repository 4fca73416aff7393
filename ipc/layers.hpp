// The layers: what planners read.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ipc/layout.hpp"
#include "ipc/port.hpp"
#include "ipc/span.hpp"

namespace gvom::ipc {

/// Layers being written. Arrays hold old data until written; the header is zero but for its size.
/// Destroyed without having been published, it gives its chunk back.
class LayersWriter {
 public:
  [[nodiscard]] Layers& header() const { return *reinterpret_cast<Layers*>(loan_.data()); }
  /// size_xy * size_xy values, [y][x], of a float layer (height .. last_seen); empty for the others.
  [[nodiscard]] Span<float> layer_f(LayerId id) const;
  /// The same of flags, visibility or cost; empty for the others.
  [[nodiscard]] Span<std::uint8_t> layer_u8(LayerId id) const;
  [[nodiscard]] LayerArrays arrays() const;  ///< All of them.

 private:
  friend class LayersPublisher;
  LayersWriter(Loan loan, const LayersLayout& layout) : loan_(std::move(loan)), layout_(layout) {}
  Loan loan_;
  LayersLayout layout_;
};

class LayersPublisher {
 public:
  static Expected<LayersPublisher> open(Runtime& runtime);

  /// For a grid of size_xy * size_xy columns, size_z high. Errors: too_large, exhausted.
  Expected<LayersWriter> loan(int size_xy, int size_z);

  /// Stamps mono_published_ns and sends; returns the sequence number. Who joins later gets the newest.
  std::uint64_t publish(LayersWriter&& writer, std::int64_t stamp_ns, std::uint64_t epoch);

  [[nodiscard]] bool has_subscribers() const { return port_.has_subscribers(); }

 private:
  explicit LayersPublisher(OutPort port) : port_(std::move(port)) {}
  OutPort port_;
};

/// How long ago each stage was, for the buffer map whose packets came last. Negative: that stage has no time.
struct StageAges {
  std::chrono::nanoseconds received, mapped, map_published, fused, published;
};

class LayersSample {
 public:
  explicit LayersSample(Chunk chunk);

  [[nodiscard]] const Layers& header() const { return *reinterpret_cast<const Layers*>(chunk_.data()); }
  [[nodiscard]] int size_xy() const { return header().grid.size[0]; }

  /// size_xy * size_xy values, [y][x], of a float layer (height .. last_seen); empty for the others.
  [[nodiscard]] Span<const float> layer_f(LayerId id) const;
  /// The same of flags, visibility or cost; empty for the others.
  [[nodiscard]] Span<const std::uint8_t> layer_u8(LayerId id) const;

  /// Index into the spans of the column that holds the point (metres, odom); nothing outside the grid.
  [[nodiscard]] std::optional<std::size_t> index_of(double x_m, double y_m) const;
  /// Index of column (x, y), 0 .. size_xy - 1 each.
  [[nodiscard]] std::size_t at(int x, int y) const {
    return std::size_t(y) * std::size_t(size_xy()) + std::size_t(x);
  }

  /// Of the data: since the newest packet in them was received (ipc/freshness.hpp). kUnknownAge if they do
  /// not say it. A planner watches this: a dead publisher says nothing, a slow one publishes old data.
  [[nodiscard]] std::chrono::nanoseconds age() const;
  /// Since these layers were published, whatever is in them.
  [[nodiscard]] std::chrono::nanoseconds publish_age() const;
  [[nodiscard]] StageAges stage_ages() const;

  /// Names of lidars that are not in the map (LidarStatus::missing): blind sides. Among them those that
  /// publish maps but are unknown to fusion's configuration.
  [[nodiscard]] std::vector<std::string> missing_lidars() const;

  /// A lidar of whose newest sweep columns are missing.
  struct IncompleteLidar {
    std::string name;
    double columns_seen_fraction;  ///< Above 0, under 1.
  };
  [[nodiscard]] std::vector<IncompleteLidar> incomplete_lidars() const;

 private:
  Chunk chunk_;
  LayersLayout layout_;
};

class LayersSubscriber {
 public:
  static Expected<LayersSubscriber> open(Runtime& runtime);

  /// The oldest unread layers.
  std::optional<LayersSample> take();
  /// The newest, older unread ones are given back unread.
  std::optional<LayersSample> take_newest();

  [[nodiscard]] bool has_data() const { return port_.has_data(); }
  [[nodiscard]] const InCounters& counters() const { return port_.counters(); }
  std::optional<std::string> new_refusal() { return port_.new_refusal(); }
  [[nodiscard]] const std::string& newest_refusal() const { return port_.newest_refusal(); }
  InPort& port() { return port_; }

 private:
  explicit LayersSubscriber(InPort port) : port_(std::move(port)) {}
  InPort port_;
};

}  // namespace gvom::ipc
