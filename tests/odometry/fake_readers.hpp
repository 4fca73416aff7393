// Stand-ins for the readers of gvom-odometry, each for a child process.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "tests/ipc/processes.hpp"

namespace gvom::test {

/// Announces itself, then says every few milliseconds that `maps` maps were taken, until `done`.
std::function<void()> fusion(const ipc::test::Step& done, std::uint64_t maps = 0);

/// Takes every odometry message in order, each `pause` after the last, never more than 32 waiting for it.
std::function<void()> lossless_ingest(const std::string& name, const ipc::test::Step& done,
                                      std::chrono::milliseconds pause, std::uint64_t poses);

/// Acknowledges the first `until` messages (0: all) as they come, and goes on saying so; reaches 1 of
/// `joined` when it has begun to.
std::function<void()> ingest(const std::string& name, const ipc::test::Step& done, std::uint64_t until = 0,
                             ipc::test::Step* joined = nullptr);

}  // namespace gvom::test
