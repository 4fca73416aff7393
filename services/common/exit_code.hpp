// How every executable ends: the codes of sysexits.h, which systemd units tell apart.
#pragma once

namespace gvom::services {

enum class ExitCode : int {
  ok = 0,
  usage = 64,          ///< The command line is wrong.
  bad_data = 65,       ///< A recording is.
  unavailable = 69,    ///< Something needed is not there (a port, a device, a GPU).
  internal = 70,       ///< A defect of ours.
  try_again = 75,      ///< It may work after a restart (the broker is gone, a reader is missing).
  configuration = 78,  ///< The vehicle file or a --set is wrong: restarting does not help.
};

/// For the `return` of main.
constexpr int to_int(ExitCode code) {
  return static_cast<int>(code);
}

}  // namespace gvom::services
