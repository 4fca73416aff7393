// Why a process is not there, as far as systemd knows.
#pragma once

#include <string>

namespace gvom::ctl {

/// Properties of a unit, in systemd's words.
struct UnitState {
  std::string unit;     ///< "gvom-fusion.service"
  std::string load;     ///< "loaded", "not-found", "masked", ...
  std::string file;     ///< "enabled", "disabled", "static", ...; empty: not known
  std::string active;   ///< "active", "activating", "failed", "inactive", ...
  std::string sub;      ///< "auto-restart", ...
  std::string result;   ///< "success", "exit-code", "signal", "watchdog", ...
  int exit_status = 0;  ///< Of the main process's last end: an exit code, or a signal.
  std::string status;   ///< The process's last word: its error, if it ended with one.
};

/// One line: how the unit is, why, and what to do. Empty for one that runs.
std::string why_not_running(const UnitState& state);

}  // namespace gvom::ctl
