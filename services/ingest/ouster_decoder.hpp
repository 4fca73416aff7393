// Ouster lidar packets to sweeps.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/ingest/decoder.hpp"
#include "services/ingest/ouster_geometry.hpp"
#include "services/ingest/ouster_turns.hpp"
#include "services/ingest/sweep_builder.hpp"

namespace gvom::ingest {

/// A sweep is a frame of the sensor. It is closed by the arrival of its last column or of the next frame.
class OusterDecoder final : public Decoder {
 public:
  /// `state` must outlive the decoder.
  OusterDecoder(OusterMetadata metadata, const SourceOptions& options, SourceState& state);

  [[nodiscard]] bool recognises(const Packet& packet) const override;
  [[nodiscard]] std::string expects() const override;
  [[nodiscard]] bool is_side_packet(const Packet& packet) const override;
  [[nodiscard]] bool is_of_this_sensor(const Packet& packet) const override;
  void name_other(const Packet& packet, KindText& out) const override;
  [[nodiscard]] std::string override_advice(const Packet& packet) const override;
  [[nodiscard]] std::uint64_t sensor_id(const Packet& packet) const override;
  [[nodiscard]] double most_packets_per_s() const override;
  [[nodiscard]] double least_packets_per_s() const override;
  [[nodiscard]] std::size_t most_returns() const override;
  bool decode(const Packet& packet, Sweep& out) override;
  [[nodiscard]] std::optional<std::int64_t> packet_time_ns() const override { return packet_time_ns_; }
  bool finish(Sweep& out) override;
  void reset() override;

 private:
  enum class ColumnState : std::uint8_t { missing, received, outside_window };
  enum class Belongs { open_frame, next_frame, closed_frame, just_completed, nowhere };

  /// A frame begins with this packet.
  void watch_turn(const std::uint8_t* packet, std::uint16_t frame, bool follows);
  [[nodiscard]] Belongs classify(std::uint16_t frame) const;
  [[nodiscard]] bool is_repeated(const std::uint8_t* packet) const;
  bool count_stray(Belongs belongs, const std::uint8_t* packet);
  void begin(std::uint16_t frame);
  bool close(Sweep& out);
  [[nodiscard]] bool usable(const OusterColumn& column, std::uint64_t middle_ns) const;
  void use(const Packet& packet);
  void use_column(const std::uint8_t* bytes, const OusterColumn& column);
  std::size_t project(const std::uint8_t* pixels, std::uint16_t measurement_id, std::uint32_t time_index);
  void count_skipped_frames(std::uint16_t frame);

  OusterMetadata metadata_;
  OusterGeometry geometry_;
  SourceState& state_;
  SweepBuilder builder_;
  OusterTurns turns_;
  RestartDetector restart_;
  std::vector<Return> scratch_;       // the returns of one column
  std::vector<std::uint64_t> times_;  // of one packet
  std::vector<ColumnState> fresh_;    // a frame of which nothing came, by measurement id
  std::vector<ColumnState> columns_;  // the open frame
  int received_ = 0;                  // columns of the open frame
  int highest_ = -1;                  // measurement id of the open frame so far
  std::uint16_t frame_ = 0;
  bool any_frame_ = false;
  bool open_ = false;
  bool whole_ = false;          // the open frame was seen from its beginning
  std::int64_t newest_ns_ = 0;  // newest column of the open frame, or of the one just completed
  std::optional<std::int64_t> packet_time_ns_;
};

}  // namespace gvom::ingest
