// What systemd knows of our units.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

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

 private:
  struct Close {
    void operator()(sd_bus* bus) const;
  };
  std::unique_ptr<sd_bus, Close> bus_;
};

}  // namespace gvom::ctl
