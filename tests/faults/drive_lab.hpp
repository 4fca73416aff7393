// A Warthog that is driven through an avenue in real time, by the real processes, which can be made to fail.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "tests/faults/lab.hpp"

namespace gvom::test {

/// What the vehicle's process reads and tells, in memory that all share.
struct DriveBoard {
  std::atomic<bool> lidar{true};     ///< It sends.
  std::atomic<bool> odometry{true};  ///< It is told.
  std::atomic<double> jump_m{0};     ///< To the left, of all odometry from now on.
  std::atomic<bool> is_up{false};
  std::atomic<double> speed_mps{0};  ///< Over the ground, as all that follows.
  std::atomic<double> driven_m{0};
  std::atomic<double> x_m{0};
  std::atomic<double> y_m{0};
  std::atomic<double> nearest_m{10};  ///< To a tree, so far.
  std::atomic<bool> mishap{false};
  std::atomic<bool> arrived{false};
  std::atomic<std::uint64_t> deadlines_passed{0};
};

/// What came of a fault.
struct Stop {
  double speed_mps;   ///< When it began.
  double rolled_m;    ///< Until the vehicle stood.
  double seconds;     ///< Likewise.
  double goes_on_s;   ///< After the cure, until it was at 1 m/s again.
  std::string words;  ///< Of the planner, at the stand.
};

class DriveLab {
 public:
  /// Everything runs when it returns, the vehicle stands; the test fails if not.
  DriveLab();
  ~DriveLab();
  DriveLab(const DriveLab&) = delete;
  DriveLab& operator=(const DriveLab&) = delete;

  /// Waits until it drives at full speed, breaks, waits until it stands, cures, waits until it drives. The
  /// test fails where one of that does not come, or the vehicle touches something.
  Stop check_stop(const std::string& fault, const std::function<void()>& break_it,
                  const std::function<void()>& cure_it);

  [[nodiscard]] bool drives() const;  ///< Waits for nearly the full speed.
  [[nodiscard]] bool stands() const;  ///< Waits for it.
  /// How far it may roll if it hears no more for `heard_s`: delay, actuators and brakes come on top.
  [[nodiscard]] double may_roll_m(double speed_mps, double heard_s) const;
  std::unique_ptr<Program> start_planner() const;
  void stop();

  TemporaryFolder folder;
  DriveBoard* board;
  std::unique_ptr<Graph> graph;
  std::unique_ptr<Observer> observer;
  std::unique_ptr<Program> planner;

 private:
  std::unique_ptr<ipc::test::Child> vehicle_;
};

}  // namespace gvom::test
