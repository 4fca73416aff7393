#include "services/fusion/unknown_lidars.hpp"

#include <algorithm>

#include "ipc/topic.hpp"

namespace gvom::fusion {

void UnknownLidars::take(const ipc::Progress& progress, std::int64_t now_ns) {
  const std::string_view name = ipc::text_of(progress.reader);
  const bool known = std::any_of(known_.begin(), known_.end(),
                                 [name](const services::LidarConfig& lidar) { return lidar.name == name; });
  if (known || name == kOwnName || !ipc::is_lidar_name(name)) return;
  const auto same = [name](const Heard& lidar) { return ipc::text_of(lidar.name) == name; };
  const auto older = [](const Heard& a, const Heard& b) { return a.mono_ns < b.mono_ns; };
  auto place = std::find_if(heard_.begin(), heard_.end(), same);
  if (place == heard_.end()) place = std::min_element(heard_.begin(), heard_.end(), older);
  ipc::set_text(place->name, name);
  place->mono_ns = now_ns;
}

}  // namespace gvom::fusion
