// What moves, by where the map's obstacles get on, and the room that it can reach.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "services/common/planner_config.hpp"
#include "services/planner/map_view.hpp"
#include "services/planner/standers.hpp"

namespace gvom::planner {

/// A column that is HARD or SOFT, and was open ground with nothing within `kEdge_m` of it `kBack_ns` ago, may
/// be of something that moves: who walks fills a voxel for so short a time that he is mostly SOFT. So may be
/// one of a thing that shows itself late, or by turns, or piece by piece: that stays. Only where such columns
/// get on by `kMoved_m` within `kGoing_ns`, no faster than `kRuns_mps`, and leave where they were, something
/// moves; beside other things, where it does so twice, straight on. It is believed to for `kHold_ns`. The
/// room that it can reach until the vehicle is there, or stands, is closed (HARD), so the vehicle goes
/// behind, slows down or waits. Who turns around walks where he just came from, and that was not open
/// `kBack_ns` ago: with nothing else near, whatever stands there is followed. Grass that flickers gets on,
/// too, each time another way. What is sure to move, since it got on three times straight on or stands alone
/// and is as large as a person, may turn: when it has not got on for `kTurns_ns`, all around it is closed.
/// Who stood alone and sets off (`Standers`) is sure to move, too.
/// What is not sure to move, and flickers on where the vehicle has waited for `kPatience_ns`, closes nothing
/// more until it has got on.
class Movers {
 public:
  static constexpr std::int64_t kBack_ns = 600'000'000;
  static constexpr std::int64_t kGoing_ns = 1'000'000'000;
  static constexpr std::int64_t kHold_ns = 1'200'000'000;
  static constexpr std::int64_t kTurns_ns = 500'000'000;  ///< Since it got on; then it may turn.
  static constexpr std::int64_t kPatience_ns = 5'000'000'000;
  /// Within the blind ring and a metre the map keeps who walks where he was: he does not get on there, and
  /// who is sure to move is held for so long.
  static constexpr std::int64_t kHoldBeside_ns = 3'000'000'000;
  static constexpr double kHere_m = 1;  ///< So far from where it waited the vehicle has got on.
  static constexpr double kMoved_m = 0.5;
  static constexpr double kRuns_mps = 3;
  static constexpr double kEdge_m = 0.4;  ///< So far the edge of what stands may flicker.
  static constexpr double kSight_m = 15;  ///< From the vehicle; farther off, too little is known.
  static constexpr double kByHole_m = 1;  ///< Nearer to a hole nothing is seen to move.
  static constexpr double kLargest_m2 = 1;
  static constexpr double kWalks_mps = 1.4;
  static constexpr double kAround_m = 1;  ///< Closed around a mover,
  static constexpr double kWidens = 0.3;  ///< and so much more for each metre that it may get on,
  static constexpr double kAhead_m = 3;   ///< at most so far.
  static constexpr double kBefore_m = 5;  ///< So far beyond that it costs to pass before who is sure to move.
  static constexpr double kLeast_s = 1;   ///< What sets off beside someone needs that.

  struct Disc {
    Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
    double radius_m = 0;
    bool sure = false;  ///< It is sure to move.
  };

  /// @param n_xy the largest map, columns along an edge
  /// @param blind_m nearer than this lidars may see no ground
  Movers(const VehicleLimits& vehicle, int n_xy, double blind_m);

  /// Forgets all: the map begins anew.
  void clear();
  /// Each cycle with a map, which may be that of the cycle before; nothing closed in it.
  /// @param speed_mps of the vehicle
  void observe(const MapView& map, const Eigen::Vector2d& vehicle_m, double speed_mps);
  [[nodiscard]] bool empty() const { return discs_.empty(); }
  /// Where each mover is, and what it can reach.
  [[nodiscard]] const std::vector<Disc>& discs() const { return discs_; }
  /// Whether one that is sure to move can reach the vehicle, other than from behind.
  [[nodiscard]] bool reach(const Pose2& pose) const;
  /// Each cycle in which the vehicle stops for them.
  void wait(const Eigen::Vector2d& vehicle_m, std::int64_t stamp_ns);
  /// How long it has done so where it is, all together.
  [[nodiscard]] std::int64_t waited_ns() const { return waited_ns_; }
  /// The map with flags that hold these, HARD, and SOFT what is before them. Borrows the map's arrays, and is
  /// valid until the next call.
  MapView close(const MapView& map);
  /// The same for who brakes in any case: the room that they can reach is SOFT, so he ends behind them
  /// rather than before them.
  MapView discourage(const MapView& map);

 private:
  static constexpr std::size_t kMost = 64;
  static constexpr std::size_t kPasts = 16;
  static constexpr std::int64_t kPastEvery_ns = 50'000'000;
  static_assert((kPasts - 1) * kPastEvery_ns > kBack_ns);
  static constexpr double kApart_m = 1.5;  ///< Columns nearer than this are of the same mover.

  /// What is kept of a map.
  struct Past {
    std::int64_t stamp_ns = 0;
    Cells cells;
    std::vector<std::uint8_t> known;     // 1: there is ground
    std::vector<std::uint8_t> standing;  // 1: something is on it
  };
  /// Columns near each other.
  struct Found {
    Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
    int columns = 0;
  };
  /// The same from cycle to cycle.
  struct Track {
    Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
    std::int64_t seen_ns = 0;
    Eigen::Vector2d from_m = Eigen::Vector2d::Zero();  ///< Where it was
    std::int64_t from_ns = 0;                          ///< then; how far it gets from there is measured.
    Eigen::Vector2d direction = Eigen::Vector2d::Zero();
    std::int64_t moved_ns = 0;  ///< When it last had got on by `kMoved_m`.
    int straight = 0;           ///< How often it last got on in the direction before.
    bool moves = false;
    bool sure = false;
  };

  void remember(const MapView& map);
  /// The newest that is old enough; nullptr: there is none.
  [[nodiscard]] const Past* past_of(std::int64_t stamp_ns) const;
  [[nodiscard]] const Past* newest_past() const;
  [[nodiscard]] static bool is_by_hole(const MapView& map, int index);
  [[nodiscard]] static bool was_open(const Past& past, const Eigen::Vector2d& place_m);
  /// Little else stands around it.
  [[nodiscard]] static bool is_alone(const MapView& map, const Eigen::Vector2d& place_m);
  void find(const MapView& map, const Past& past, const Eigen::Vector2d& vehicle_m);
  void add(const Eigen::Vector2d& place_m);
  void follow(const MapView& map, const Eigen::Vector2d& vehicle_m);
  /// Follows who has set off from where he stood.
  void begin(const Standers::SetOff& one, std::int64_t stamp_ns);
  [[nodiscard]] std::int64_t hold_ns(const Track& track, const Eigen::Vector2d& vehicle_m) const;
  /// A new track; if there are `kMost`, in place of the one that does not move and was not seen for longest.
  /// nullptr: all move.
  Track* add_track();
  /// Whose these columns are: the nearest of those that can have come there; nullptr: of none.
  [[nodiscard]] Track* track_of(const Eigen::Vector2d& middle_m, std::int64_t stamp_ns);
  static void go_on(const MapView& map, const Eigen::Vector2d& middle_m, bool alone, Track& track);
  void mark(const Cells& cells, const std::vector<Disc>& discs, std::uint8_t flag);
  [[nodiscard]] static Disc ahead_of(const Track& track, double ahead_m);
  void close_ahead(std::int64_t stamp_ns, const Eigen::Vector2d& vehicle_m, double speed_mps);

  VehicleLimits vehicle_;
  double beside_m_;
  std::array<Past, kPasts> pasts_;
  std::size_t taken_ = 0;
  std::optional<std::int64_t> observed_ns_;  ///< The stamp of the newest map.
  std::vector<Found> found_;
  Standers standers_;
  std::vector<Track> tracks_;
  std::vector<Disc> discs_;
  std::vector<Disc> before_;  ///< Where they get later.
  Eigen::Vector2d waits_at_m_ = Eigen::Vector2d::Zero();
  std::int64_t waits_at_ns_ = 0;  ///< When it last did.
  std::int64_t waited_ns_ = 0;
  std::vector<std::uint8_t> flags_;
};

}  // namespace gvom::planner
