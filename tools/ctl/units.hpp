// What systemd knows of our units.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "tools/ctl/unit_state.hpp"

struct sd_bus;

namespace gvom::ctl {

/// "gvom-ingest-front" -> "gvom-ingest@front.service", "gvom-fusion" -> "gvom-fusion.service".
std::string unit_of(const std::string& process);

/// A connection to systemd, if it runs this machine. Open it as root, before becoming another user, where
/// there is no D-Bus: systemd's own socket lets in root alone.
class Units {
 public:
  Units();

  /// How often systemd has restarted the process; nothing if there is no systemd or no such unit. Within a
  /// quarter of a second; a systemd that does not answer in that time is not asked again.
  std::optional<std::uint64_t> restarts(const std::string& process);

  /// Nothing without a systemd that answers.
  std::optional<UnitState> state(const std::string& process);

  /// Puts a job into systemd's queue and does not wait for its end: "TryRestartUnit" (one that runs is
  /// started anew), "StopUnit". What systemd says if it refuses.
  std::optional<std::string> order(const char* method, const std::string& unit);

  [[nodiscard]] bool is_open() const { return bus_ != nullptr; }

 private:
  std::string text(const std::string& path, const char* interface, const char* property);
  struct Close {
    void operator()(sd_bus* bus) const;
  };
  std::unique_ptr<sd_bus, Close> bus_;
};

}  // namespace gvom::ctl
