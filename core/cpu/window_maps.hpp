// The window's maps as `presence` reads them (R11).
#pragma once

#include "core/window.hpp"

namespace gvom::cpu {

class WindowMaps {
 public:
  explicit WindowMaps(const Window& window) : maps_(window.maps()) {}

  [[nodiscard]] std::int32_t count() const { return static_cast<std::int32_t>(maps_.size()); }
  [[nodiscard]] std::int64_t stamp_ns(std::int32_t i) const { return view(i).stamp_ns; }
  [[nodiscard]] std::int32_t lookup(std::int32_t i, const Int3& world) const {
    return lookup_at(view(i), world);
  }

 private:
  [[nodiscard]] const BrickMapView& view(std::int32_t i) const {
    return maps_[static_cast<std::size_t>(i)].view;
  }

  const std::vector<WindowMap>& maps_;
};

}  // namespace gvom::cpu
