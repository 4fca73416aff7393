#include <cstdio>

#include "ipc/runtime.hpp"
#include "tools/ctl/bus_watch.hpp"
#include "tools/ctl/commands.hpp"
#include "tools/ctl/render.hpp"

namespace gvom::ctl {

namespace {

constexpr std::chrono::milliseconds kStep{50};

/// Whether to look on: there is a broker that may let us in, and something is still to be heard.
bool goes_on(const BusWatch& watch, const Watched& watched) {
  const Broker broker = watch.broker();
  if (broker.state != BrokerState::up || watched.lifecycle.stopping()) return false;
  const bool refused = !broker.joined && !broker.note.empty();
  return !refused && !is_complete(watch.observed(), watched.expected);
}

int exit_code_of(const Snapshot& snapshot) {
  if (snapshot.broker.state == BrokerState::absent && !snapshot.config_error.empty())
    return to_int(services::ExitCode::configuration);
  const bool outside = snapshot.broker.state == BrokerState::up && !snapshot.broker.joined;
  if (snapshot.broker.state == BrokerState::absent || outside) return to_int(services::ExitCode::unavailable);
  return snapshot.problems.empty() ? 0 : kNotWell;
}

}  // namespace

int show_status(const Watched& watched, std::chrono::milliseconds patience, bool json) {
  BusWatch watch;
  const auto deadline = std::chrono::steady_clock::now() + patience;
  do {
    watch.step(kStep);
  } while (goes_on(watch, watched) && std::chrono::steady_clock::now() < deadline);
  const Snapshot snapshot =
      assess(watch.broker(), watch.observed(), watched.expected, watched.surroundings, ipc::Moment::now());
  std::fputs((json ? to_json(snapshot) : to_table(snapshot)).c_str(), stdout);
  std::fflush(stdout);
  return exit_code_of(snapshot);
}

}  // namespace gvom::ctl
