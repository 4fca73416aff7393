// Who stood, alone and as large as a person, and sets off.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "services/planner/lone.hpp"

namespace gvom::planner {

/// What moves is told by ground that was open (`Movers`): about a second after somebody set off. Who stood
/// still before is told sooner, by the middle of what stands alone: posts and bushes keep theirs to a share
/// of a column. One that has kept its own for `kStood_ns`, and is off it by `kOff` columns within
/// `kQuick_ns`, in two maps, has set off; unless it has only shown more of itself, or less. (Seen in 12
/// drives of 100 s: two walkers, 0.45 and 0.55 s after they set off, and six things that stood.)
class Standers {
 public:
  static constexpr std::int64_t kStood_ns = 1'000'000'000;
  static constexpr std::int64_t kQuick_ns = 600'000'000;
  static constexpr double kKept = 0.4;                ///< Columns: so far the middle of what stands flickers,
  static constexpr double kOff = 1.25;                ///< and so far it has got on.
  static constexpr double kLess = 0.6, kMore = 1.75;  ///< Of its columns; on one side alone it grows by more.

  struct SetOff {
    Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d direction = Eigen::Vector2d::Zero();
  };

  Standers();

  void clear() { known_.clear(); }
  /// Each map once. @return who has set off in it; valid until the next call.
  /// @param sight_m from the vehicle; who is farther off is not looked at
  const std::vector<SetOff>& observe(const MapView& map, const Eigen::Vector2d& vehicle_m, double sight_m);

 private:
  static constexpr std::size_t kMost = 1024;
  static constexpr std::int64_t kHidden_ns = 500'000'000;   ///< Not seen for longer, it begins anew,
  static constexpr std::int64_t kFollows_ns = 500'000'000;  ///< A nearer vehicle sees another side of it.

  struct Stander {
    Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d stood_at_m = Eigen::Vector2d::Zero();
    double columns = 0;  ///< When it stood.
    std::int64_t seen_ns = 0;
    std::int64_t since_ns = 0;
    std::int64_t kept_ns = 0;  ///< When it last was where it stood.
    bool off = false;          ///< In the map before this.
  };

  void see(const Lone& lone, std::int64_t stamp_ns, double cell_m);
  void judge(const Lone& lone, std::int64_t stamp_ns, double cell_m, Stander& stander);

  static Stander begun(const Lone& lone, std::int64_t stamp_ns);

  std::vector<Stander> known_;
  std::vector<SetOff> set_off_;
};

}  // namespace gvom::planner
