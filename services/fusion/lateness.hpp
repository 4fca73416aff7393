// Whether fusion keeps up with the maps: how far the layers that planners had were behind the packets.
#pragma once

#include <cstdint>

#include "ipc/freshness.hpp"
#include "ipc/messages.hpp"
#include "services/common/words.hpp"

namespace gvom::fusion {

class Lateness {
 public:
  /// A map was taken from the queue, where it had waited since it was published. A replay that waits for its
  /// readers is never late.
  void took(const ipc::BrickMap& map, std::int64_t now_ns);

  /// New layers went out. `received`: of their newest packet.
  void published(const ipc::Moment& received, const ipc::Moment& now);

  /// Of the layers that went out last. kUnknownAge: none yet.
  [[nodiscard]] std::chrono::nanoseconds age(const ipc::Moment& now) const;

  /// "the layers were 2.1 s behind the packets", for two seconds after it was last so.
  void describe(const ipc::Moment& now, services::Words& words);

 private:
  ipc::Moment received_;         // of the newest packet in the last layers
  bool waited_ = false;          // a map since the last layers, too long
  bool lossless_ = false;        // the last map
  std::int64_t behind_ns_ = 0;   // the most of late
  std::int64_t noticed_ns_ = 0;  // when it was last so
};

}  // namespace gvom::fusion
