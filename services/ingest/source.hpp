// Where sweeps come from: a recording or a live sensor, through the same decoder.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "core/sweep.hpp"
#include "services/ingest/address.hpp"

namespace gvom::ingest {

/// Whose packets came, in words: a text that ends with 0.
using KindText = std::array<char, 64>;

/// Why a message of ROS 2 could not be used: a text that ends with 0, cut where it is too long.
using RefusalText = std::array<char, 160>;

/// Why input was not used. Everything that is dropped is in exactly one of these.
struct SourceCounters {
  std::uint64_t packets = 0;                ///< Packets handed to the decoder.
  std::uint64_t sweeps = 0;                 ///< Sweeps handed out (complete or not).
  std::uint64_t incomplete_sweeps = 0;      ///< ... of these, with columns missing.
  std::uint64_t dropped_sweeps = 0;         ///< Not handed out: under `min_sweep_fraction`.
  std::uint64_t misfit_sweeps = 0;          ///< Not handed out: of another mode or pace than the source says.
  std::uint64_t withheld_sweeps = 0;        ///< Live, of a sender that has not had a sensor's rate yet.
  std::uint64_t foreign_packets = 0;        ///< Another size, another protocol, a frame of another time.
  std::uint64_t second_sensor_packets = 0;  ///< Of this sensor's kind, but of another sensor.
  std::uint64_t slow_packets = 0;           ///< Live, of a sender that has not had a sensor's rate.
  std::uint64_t truncated_packets = 0;      ///< Captured shorter than sent.
  std::uint64_t duplicate_packets = 0;
  std::uint64_t out_of_order_packets = 0;  ///< Late, but still of the open sweep: used.
  std::uint64_t late_packets = 0;          ///< Of a sweep that was closed already: dropped.
  std::uint64_t fragments = 0;             ///< IP fragments seen.
  std::uint64_t lost_fragments = 0;        ///< Datagrams given up because a fragment is missing.
  std::uint64_t kernel_drops = 0;          ///< Lost in the socket's queue (live only).
  std::uint64_t invalid_columns = 0;       ///< That the sensor marked invalid, or that cannot be.
  std::uint64_t overflow_returns = 0;      ///< Beyond `max_returns`.

  // Nothing that was dropped: what tells a person more about the above.
  std::uint64_t columns = 0;          ///< Of closed sweeps, those that came (Velodyne: firing blocks).
  std::uint64_t missing_columns = 0;  ///< ... and those that did not.
  double dropped_fractions = 0;      ///< What the dropped sweeps had of their columns, 0 .. 1 each, added up.
  double best_dropped_fraction = 0;  ///< The most of these.
  std::uint64_t foreign_size_changes = 0;  ///< Foreign packets of another size than the foreign one before.
  std::uint64_t foreign_size = 0;          ///< Of the newest foreign packet, bytes.
  std::uint64_t side_packets = 0;          ///< Of the foreign ones, the sensor's own: IMU, position, zones.
  Address slow_address{};                  ///< Who sent the newest slow packet.
  Address second_address{};                ///< Who sent the newest packet of a second sensor.
  KindText foreign_kind{};                 ///< Whose the newest foreign packet is, if its bytes prove it.
  KindText second_kind{};                  ///< Whose the newest packet of a second sensor is, likewise.
  RefusalText refusal{};                   ///< Why the newest foreign message is not used.
};

/// What `Source::next` found.
enum class SourceEvent {
  kSweep,  ///< `out` holds a sweep.
  kIdle,   ///< Live: nothing whole within the timeout. Call again.
  kEnd,    ///< A recording is at its end.
};

struct SourceOptions {
  double min_sweep_fraction = 0.5;
  std::size_t max_returns = 262144;
  bool by_arrival = false;           ///< Stamps by the arrival of packets: see ArrivalClock.
  std::int64_t clock_offset_ns = 0;  ///< Added to all stamps.
};

/// Why a source does not open.
struct SourceError {
  enum class Kind {
    bad_data,     ///< What was asked for is wrong, or the recording is: only a person helps.
    unavailable,  ///< It may be there later: a port that is taken, an address that is not up yet.
  };
  std::string what;  ///< Which file or port, and why.
  Kind kind = Kind::bad_data;

  SourceError(std::string text, Kind why = Kind::bad_data) : what(std::move(text)), kind(why) {}
};

class Source {
 public:
  virtual ~Source() = default;

  /// Fills `out` (cleared first) with the next sweep. Allocates nothing after the first few sweeps.
  /// A recording never returns kIdle. An error (a corrupt file: path, packet number or line, reason)
  /// ends the source.
  virtual tl::expected<SourceEvent, std::string> next(Sweep& out, std::chrono::milliseconds timeout) = 0;

  /// Starts a recording again from its first sweep (a looped replay); an error for a live source.
  virtual tl::expected<void, std::string> rewind() = 0;

  /// True for sensors on the network: they do not wait for anybody.
  [[nodiscard]] virtual bool is_live() const = 0;

  /// More packets in a second do not come from one sensor of this kind; 0: not known.
  [[nodiscard]] virtual double most_packets_per_s() const { return 0; }

  /// Returns that a sweep can have, by what is known of the sensor; 0: not known.
  [[nodiscard]] virtual std::size_t most_returns() const { return 0; }

  /// For sensors without absolute time (Velodyne counts microseconds past the hour): a time near now
  /// on the odometry's clock, from which the hour is taken. Others ignore it.
  virtual void set_time_hint(std::int64_t stamp_ns) = 0;

  [[nodiscard]] virtual const SourceCounters& counters() const = 0;

  /// Things a person should hear of once, such as metadata keys that were missing and what stands in.
  [[nodiscard]] virtual const std::vector<std::string>& warnings() const = 0;
};

/// What is wrong with `max_returns` of the lidar: less than a sweep can have. Empty if it is well.
std::string lack_of_room(const std::string& lidar, std::size_t max_returns, const Source& source);

/// Opens `ouster:FILE.pcap?meta=FILE.json`, `ouster-udp:PORT?meta=FILE.json`, `velodyne:FILE.pcap?model=M`,
/// `velodyne-udp:PORT?model=M` (M: see known_velodyne_models()), `scans:PATH` or `bag:PATH?topic=T`;
/// README.md has all options.
tl::expected<std::unique_ptr<Source>, SourceError> open_source(const std::string& uri,
                                                               const SourceOptions& options);

}  // namespace gvom::ingest
