// A handle of Cyclone's that is deleted when it goes away.
#pragma once

#include <utility>

#include <dds/dds.h>

namespace gvom::dds {

class Entity {
 public:
  Entity() = default;
  /// Takes what dds_create_* gave; an error (below 0) counts as none.
  explicit Entity(dds_entity_t handle) : handle_(handle) {}
  ~Entity() { reset(); }
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  /// While one of its listeners runs, this waits.
  void reset() {
    if (handle_ > 0) dds_delete(std::exchange(handle_, 0));
  }

  [[nodiscard]] dds_entity_t get() const { return handle_; }
  [[nodiscard]] bool valid() const { return handle_ > 0; }

 private:
  dds_entity_t handle_ = 0;
};

}  // namespace gvom::dds
