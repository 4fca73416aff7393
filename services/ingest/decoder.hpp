// What turns a sensor's packets into sweeps.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/sweep.hpp"
#include "services/ingest/packet.hpp"

namespace gvom::ingest {

class Decoder {
 public:
  virtual ~Decoder() = default;

  /// True if the packet has the size and the marks of this kind of sensor's lidar packets. decode() takes
  /// only these.
  [[nodiscard]] virtual bool recognises(const Packet& packet) const = 0;

  /// What recognises() looks for, in words.
  [[nodiscard]] virtual std::string expects() const = 0;

  /// Whether a packet that is not recognised is one that such a sensor sends beside its lidar packets (IMU,
  /// position, zones), maybe to the same port.
  [[nodiscard]] virtual bool is_side_packet(const Packet& packet) const = 0;

  /// Whether a packet that is recognised is of the very sensor that the source is of, as far as it tells.
  [[nodiscard]] virtual bool is_of_this_sensor(const Packet& /*packet*/) const { return true; }

  /// Whose a packet is that is not recognised, or not of this sensor, as its bytes prove: "a VLS-128, model
  /// byte 0xA1". Empty if they prove nothing.
  virtual void name_other(const Packet& packet, KindText& out) const = 0;

  /// For an error, behind name_other(): what the source takes its packets for, and how it can be told that
  /// these are right.
  [[nodiscard]] virtual std::string override_advice(const Packet& packet) const = 0;

  /// What tells this packet's sensor from others at the same address: its serial number or model; 0: nothing.
  [[nodiscard]] virtual std::uint64_t sensor_id(const Packet& packet) const = 0;

  /// More packets in a second do not come from one such sensor.
  [[nodiscard]] virtual double most_packets_per_s() const = 0;

  /// What one such sensor sends at the slowest setting that it has.
  [[nodiscard]] virtual double least_packets_per_s() const = 0;

  /// Returns that a sweep can have; Velodyne: at 10 turns a second.
  [[nodiscard]] virtual std::size_t most_returns() const = 0;

  /// The first packet of the recording: what it tells of the sensor's settings holds for most_returns().
  virtual void expect_like(const Packet& /*packet*/) {}

  /// Uses one packet. True if it closed a sweep, which is then in `out`.
  virtual bool decode(const Packet& packet, Sweep& out) = 0;

  /// The newest time, as the sensor tells it, in the packet that decode() was given last; nothing if it used
  /// none of it.
  [[nodiscard]] virtual std::optional<std::int64_t> packet_time_ns() const = 0;

  /// Closes the open sweep at the end of a recording. True if `out` holds it.
  virtual bool finish(Sweep& out) = 0;

  /// Forgets the open sweep and everything else about the stream.
  virtual void reset() = 0;

  /// See Source::set_time_hint.
  virtual void set_time_hint(std::int64_t /*stamp_ns*/) {}
};

/// Tells a stream that started again (a sensor that rebooted, a looped recording) from stray packets:
/// this many in a row that do not fit the open sweep mean that the open sweep is what is out of date.
class RestartDetector {
 public:
  void fits() { misfits_ = 0; }

  /// True if the stream is to be taken up anew with this packet.
  bool misfits() {
    if (++misfits_ < kRestartPackets) return false;
    misfits_ = 0;
    return true;
  }

 private:
  static constexpr int kRestartPackets = 8;
  int misfits_ = 0;
};

}  // namespace gvom::ingest
