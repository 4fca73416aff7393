// Velodyne lidar packets to sweeps.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "services/ingest/decoder.hpp"
#include "services/ingest/hour_clock.hpp"
#include "services/ingest/sweep_builder.hpp"
#include "services/ingest/velodyne_marks.hpp"
#include "services/ingest/velodyne_model.hpp"
#include "services/ingest/velodyne_pace.hpp"
#include "services/ingest/velodyne_shots.hpp"

namespace gvom::ingest {

/// A sweep is a turn, cut where the azimuth passes through 0. Axes: x forward (azimuth 0), y left, z up.
class VelodyneDecoder final : public Decoder {
 public:
  /// `marks` are what the packets must say of themselves. `state` must outlive the decoder.
  VelodyneDecoder(VelodyneModel model, const VelodyneMarks& marks, const SourceOptions& options,
                  SourceState& state);

  [[nodiscard]] bool recognises(const Packet& packet) const override;
  [[nodiscard]] std::string expects() const override;
  [[nodiscard]] bool is_side_packet(const Packet& packet) const override { return packet.size == 512; }
  void name_other(const Packet& packet, KindText& out) const override;
  [[nodiscard]] std::string override_advice(const Packet& packet) const override;
  [[nodiscard]] std::uint64_t sensor_id(const Packet& packet) const override;
  [[nodiscard]] double most_packets_per_s() const override;
  [[nodiscard]] double least_packets_per_s() const override;
  [[nodiscard]] std::size_t most_returns() const override;
  void expect_like(const Packet& packet) override;
  bool decode(const Packet& packet, Sweep& out) override;
  [[nodiscard]] std::optional<std::int64_t> packet_time_ns() const override { return packet_time_ns_; }
  bool finish(Sweep& out) override;
  void reset() override;
  void set_time_hint(std::int64_t stamp_ns) override { clock_.hint(stamp_ns); }

 private:
  /// Where a packet stands against the open sweep; `jump` means that the sweep ends before it in any case.
  enum class Place { next, within, duplicate, late, jump };

  Place place(std::int64_t time_ns);
  bool use(const Packet& packet, std::int64_t time_ns, bool may_cut, Sweep& out);
  void begin(std::int64_t time_ns);
  void add(const VelodyneShot& shot);
  std::size_t project(const VelodyneShot& shot, const std::uint8_t* block, int firing,
                      std::uint32_t time_index);
  bool close(Sweep& out);
  void forget();
  void check_hour();
  void check_pace(std::int64_t time_ns);

  struct LaserTrigonometry {
    double cos_vertical, sin_vertical;
  };

  const VelodyneModel model_;
  const VelodyneMarks marks_;
  VelodyneShots shots_;            // of the packet at hand
  const std::size_t max_packets_;  // of a sweep
  SourceState& state_;
  SweepBuilder builder_;
  HourClock clock_;
  RestartDetector restart_;
  VelodynePace pace_;
  std::vector<LaserTrigonometry> lasers_;
  std::array<Return, 64> scratch_{};           // the returns of one firing
  std::vector<std::int64_t> packet_times_ns_;  // of the open sweep
  bool open_ = false;
  bool dual_ = false;                // of the packet at hand
  std::int64_t start_ns_ = 0;        // packet in which the open sweep began
  std::int64_t newest_ns_ = 0;       // newest packet
  int azimuth_ = 0;                  // newest block
  std::int64_t newest_time_ns_ = 0;  // newest time of the sensor in the sweep
  int received_ = 0;                 // shots in the open sweep
  bool whole_ = false;               // a sweep was closed before the open one: it was seen from its beginning
  bool hour_checked_ = false;
  std::optional<std::int64_t> packet_time_ns_;
  bool pace_told_ = false;
};

}  // namespace gvom::ingest
