// gvom-test-hang TRIES: makes the broker hang, as it does when a process is killed in the middle of a
// publish: one that does nothing else, past our own ports, is killed and started again under its name until
// the broker no longer works off its messages. Runs as the broker's user. Prints the Unix time (ms) of the
// last kill. Exit codes: 0 the broker hangs, 75 it did not in so many tries.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <random>

#include "iceoryx_posh/popo/untyped_publisher.hpp"
#include "ipc/broker_probe.hpp"
#include "tests/ipc/processes.hpp"

namespace {

using namespace gvom;
using namespace std::chrono_literals;

void publish_for_ever(ipc::test::Step& publishes) {
  auto runtime = ipc::Runtime::connect("gvom-test-hang", 5s);
  if (!runtime) return;
  iox::popo::UntypedPublisher publisher({"gvom", "hang", "all"});
  while (true) {
    if (auto chunk = publisher.loan(8)) publisher.publish(*chunk);
    publishes.reach(1);
  }
}

long long now_ms() {
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(since).count();
}

}  // namespace

int main(int argc, char** argv) {
  const int tries = argc == 2 ? std::atoi(argv[1]) : 0;
  if (tries < 1) return 64;
  std::mt19937 random(std::random_device{}());
  long long killed_ms = 0;
  const auto broker = ipc::broker_pid();
  for (int kills = 0; kills <= tries; ++kills) {
    ipc::test::Step publishes;
    // Now the broker clears away what the last one left. If that hangs it, this one never publishes.
    ipc::test::Child publisher([&] { publish_for_ever(publishes); });
    ipc::test::eventually([&] { return publishes.reached(1); }, 2s);
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 50));
    // A slow one works, but late. In the place of one that hangs there may be another by then.
    const bool hangs = kills > 0 && !(ipc::broker_works(3s) && ipc::broker_pid() == broker);
    if (!hangs) killed_ms = now_ms();
    publisher.kill();
    if (!hangs) continue;
    std::printf("%lld after %d kills\n", killed_ms, kills);
    return 0;
  }
  return 75;
}
