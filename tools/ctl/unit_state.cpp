#include "tools/ctl/unit_state.hpp"

#include <fmt/format.h>

namespace gvom::ctl {

namespace {

/// " with exit code 78: FILE:3: ...", as much of it as is known.
std::string last_end(const UnitState& state) {
  std::string words;
  if (state.result == "exit-code")
    words = fmt::format(" with exit code {}", state.exit_status);
  else if (state.result == "signal")
    words = fmt::format(" by signal {}", state.exit_status);
  else if (!state.result.empty() && state.result != "success")
    words = " by " + state.result;
  return state.status.empty() ? words : words + ": " + state.status;
}

}  // namespace

std::string why_not_running(const UnitState& state) {
  const std::string log = "; journalctl --unit " + state.unit;
  if (state.load == "not-found") return "there is no unit " + state.unit;
  if (state.load == "masked") return fmt::format("{0} is masked: systemctl unmask {0}", state.unit);
  if (state.active == "failed") return fmt::format("{} failed{}{}", state.unit, last_end(state), log);
  if (state.sub == "auto-restart" || state.active == "deactivating")
    return fmt::format("{} is started again and again, it ended{}{}", state.unit, last_end(state), log);
  if (state.active == "activating")
    return fmt::format("{} is starting{}", state.unit, state.status.empty() ? "" : ": " + state.status);
  if (state.active != "inactive") return "";
  if (state.file == "disabled")
    return fmt::format("{0} is not enabled: systemctl enable --now {0}", state.unit);
  return fmt::format("{0} is stopped: systemctl start {0}", state.unit);
}

}  // namespace gvom::ctl
