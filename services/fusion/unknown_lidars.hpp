// Lidars whose processes run beside a fusion that does not have them in its configuration: their maps are
// taken by nobody.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "ipc/messages.hpp"
#include "ipc/text.hpp"
#include "services/common/vehicle_config.hpp"

namespace gvom::fusion {

/// Fusion's own in Progress::reader.
inline constexpr char kOwnName[] = "fusion";

/// By their Progress, which every ingest sends at least four times a second. Does not allocate.
class UnknownLidars {
 public:
  explicit UnknownLidars(const std::vector<services::LidarConfig>& known) : known_(known) {}

  void take(const ipc::Progress& progress, std::int64_t now_ns);

  /// Calls `use(name)` for each that was heard in the last two seconds.
  template <typename Use>
  void for_each(std::int64_t now_ns, Use use) const {
    for (const Heard& lidar : heard_)
      if (lidar.mono_ns != 0 && now_ns - lidar.mono_ns < kRemembered_ns) use(ipc::text_of(lidar.name));
  }

 private:
  static constexpr std::int64_t kRemembered_ns = 2'000'000'000;
  struct Heard {
    char name[ipc::kNameLength] = {};
    std::int64_t mono_ns = 0;
  };

  const std::vector<services::LidarConfig>& known_;
  std::array<Heard, kMaxLidars> heard_{};
};

}  // namespace gvom::fusion
