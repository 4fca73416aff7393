// A vehicle of two live lidars that stands still, whose sensors and odometry can be made to fail.
#pragma once

#include <atomic>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "tests/ingest/ouster_builder.hpp"
#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

namespace gvom::test {

enum class SensorMode : int {
  well,
  silent,
  loss,           ///< 3 packets of 10 are not sent.
  duplicates,     ///< Each packet comes twice.
  disorder,       ///< Each two packets change places.
  second_sensor,  ///< Another of the same kind sends from 127.0.0.2 as well.
  second_alone,   ///< That one only.
  second_serial,  ///< Another of the same kind sends from the same address.
  garbage,        ///< Ten datagrams of random sizes and bytes for each packet.
  flood,          ///< Each packet comes ten times.
  other_model,    ///< Packets of another model instead.
};

enum class OdometryMode : int {
  well,  ///< 20 Hz.
  silent,
  moved,       ///< Well, but `kMoved_m` further.
  returned,    ///< Well, but `kReturned_m` further.
  not_finite,  ///< Every other pose is NaN.
  backwards,   ///< Each pose is followed by one from 0.3 s before.
  fast,        ///< 200 Hz.
  slow,        ///< 1 Hz.
};

inline constexpr double kMoved_m = 5;
inline constexpr double kReturned_m = 1;
inline constexpr std::int64_t kNoEnd = std::numeric_limits<std::int64_t>::max();

/// What the children read and tell, in memory that all share.
struct Board {
  std::atomic<SensorMode> front{SensorMode::well};
  std::atomic<SensorMode> rear{SensorMode::well};
  std::atomic<OdometryMode> odometry{OdometryMode::well};
  std::atomic<std::int64_t> front_ahead_ns{0};  // of the front sensor's clock before the odometry's
  std::atomic<std::int64_t> begin_ns{0};        // CLOCK_MONOTONIC of the drive's time 0
  std::atomic<bool> has_pose{false};            // the odometry has published
  // Of the fused maps, all that were published:
  std::atomic<std::uint64_t> maps{0};
  std::atomic<std::uint64_t> wrong_maps{0};   // with hits where the sensor cannot see
  std::atomic<double> farthest_m{0};          // hit from the vehicle in the newest map
  std::atomic<std::uint64_t> maps_in_gap{0};  // whose stamp lies within `gap_begin_ns` and `gap_end_ns`
  std::atomic<std::int64_t> gap_begin_ns{0};  // the last pose before the odometry fell silent
  std::atomic<std::int64_t> gap_end_ns{0};    // the first one after that; kNoEnd: it is silent
};

/// Both sensors see a floor of rings around the vehicle, at most 8 m away; the foreign one's are 20 m away.
inline constexpr double kFarthest_m = 8.6;

class Lab {
 public:
  /// Everything runs when it returns; the test fails if not. `sets` go on top of the vehicle's file.
  explicit Lab(const std::vector<std::string>& sets = {});

  /// Waits until the process's Health is degraded and its reason has the words; then until the cure made it
  /// ok. Reports the times with what was lost.
  void check_fault(const std::string& fault, const std::string& process, const std::string& words,
                   const std::function<void()>& break_it, const std::function<void()>& cure_it);

  [[nodiscard]] std::string reason(const std::string& process) const;
  [[nodiscard]] bool is_ok(const std::string& process) const;
  [[nodiscard]] bool layers_flow(std::uint64_t more = 5) const;
  /// What the process dropped, without what `late` counts: which it may, if somebody gets no processor.
  [[nodiscard]] std::string drops_besides(const std::string& process, const std::string& late) const;
  [[nodiscard]] std::int64_t drive_ns() const;  ///< Now, on the sensors' clock.
  void stop();

  TemporaryFolder folder;
  Board* board;
  std::unique_ptr<Graph> graph;
  std::unique_ptr<Observer> observer;

 private:
  Vehicle make_vehicle(const std::vector<std::string>& sets);
  std::unique_ptr<ipc::test::Child> odometry_;
  std::unique_ptr<ipc::test::Child> front_;
  std::unique_ptr<ipc::test::Child> rear_;
  std::unique_ptr<ipc::test::Child> judge_;
  std::uint16_t front_port_ = 0;
  std::uint16_t rear_port_ = 0;
};

/// A row for the table of tools/faults, on stdout.
void report(const std::string& fault, const std::string& seen, double recovery_s, const std::string& lost);

/// How often a fault is made to happen: GVOM_FAULTS_REPEAT, else `few`.
int repeats(int few);

/// Resident memory of a process, bytes, and its open descriptors.
std::uint64_t resident_bytes(pid_t pid);
int descriptors(pid_t pid);

}  // namespace gvom::test
