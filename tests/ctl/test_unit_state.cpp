// Why systemd does not run a unit.
#include <catch2/catch.hpp>

#include "tools/ctl/unit_state.hpp"

using namespace gvom;

TEST_CASE("how a unit is in one line, and what to do") {
  const auto words = [](ctl::UnitState state) {
    state.unit = "u.service";
    return ctl::why_not_running(state);
  };
  CHECK(words({"", "not-found", "", "inactive", "dead", "success", 0, ""}) == "there is no unit u.service");
  CHECK(words({"", "loaded", "disabled", "inactive", "dead", "success", 0, ""}) ==
        "u.service is not enabled: systemctl enable --now u.service");
  CHECK(words({"", "loaded", "enabled", "inactive", "dead", "success", 0, ""}) ==
        "u.service is stopped: systemctl start u.service");
  CHECK(words({"", "loaded", "enabled", "failed", "failed", "exit-code", 78, "v.yaml:3: no"}) ==
        "u.service failed with exit code 78: v.yaml:3: no; journalctl --unit u.service");
  CHECK(words({"", "loaded", "enabled", "activating", "auto-restart", "exit-code", 69, "no room"}) ==
        "u.service is started again and again, it ended with exit code 69: no room; journalctl --unit "
        "u.service");
  CHECK(words({"", "loaded", "enabled", "activating", "start", "success", 0, "waiting"}) ==
        "u.service is starting: waiting");
  CHECK(words({"", "loaded", "enabled", "activating", "auto-restart", "watchdog", 9, ""}) ==
        "u.service is started again and again, it ended by watchdog; journalctl --unit u.service");
  CHECK(words({"", "loaded", "enabled", "active", "running", "success", 0, "10/s"}).empty());
}
