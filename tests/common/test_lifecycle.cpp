// Signals stop the process once, softly; a second one at once.
#include <catch2/catch.hpp>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <thread>

#include <signal.h>
#include <spdlog/sinks/ostream_sink.h>
#include <sys/wait.h>
#include <unistd.h>

#include "services/common/lifecycle.hpp"
#include "services/common/log.hpp"

namespace {

using namespace std::chrono_literals;
using gvom::services::Lifecycle;
using std::chrono::steady_clock;

/// Runs `child` in a process of its own; its wait status.
template <typename Child>
int status_of(Child child) {
  const pid_t pid = fork();
  if (pid == 0) {
    signal(SIGTERM, SIG_DFL);  // Catch has its own handlers
    signal(SIGINT, SIG_DFL);
    _exit(child());
  }
  int status = 0;
  waitpid(pid, &status, 0);
  return status;
}

}  // namespace

TEST_CASE("a signal wakes a sleep, runs the callback once and is seen") {
  for (const int signal : {SIGTERM, SIGINT}) {
    Lifecycle lifecycle;
    std::atomic<int> calls{0};
    lifecycle.on_stop([&] { ++calls; });
    CHECK_FALSE(lifecycle.stopping());
    kill(getpid(), signal);
    const auto begin = steady_clock::now();
    CHECK_FALSE(lifecycle.sleep_until(begin + 20s));
    CHECK(steady_clock::now() - begin < 10s);
    CHECK(lifecycle.stopping());
    lifecycle.on_stop({});
    CHECK(calls == 1);
  }
}

TEST_CASE("a signal is known to have come from the moment at which it was sent") {
  for (int i = 0; i < 200; ++i) {
    Lifecycle lifecycle;
    kill(getpid(), i % 2 == 0 ? SIGTERM : SIGINT);
    CHECK(lifecycle.stop_asked());
    lifecycle.sleep_until(steady_clock::now() +
                          20s);  // else it is still pending when nobody takes it any more
  }
  const Lifecycle lifecycle;
  CHECK_FALSE(lifecycle.stop_asked());
}

TEST_CASE("a callback that comes after the stop runs at once") {
  Lifecycle lifecycle;
  lifecycle.request_stop();
  bool called = false;
  lifecycle.on_stop([&] { called = true; });
  CHECK(called);
}

TEST_CASE("a sleep ends at its deadline") {
  Lifecycle lifecycle;
  const auto deadline = steady_clock::now() + 30ms;
  CHECK(lifecycle.sleep_until(deadline));
  CHECK(steady_clock::now() >= deadline);
}

TEST_CASE("a second signal ends the process at once with 128 + its number") {
  const int status = status_of([] {
    Lifecycle lifecycle;
    kill(getpid(), SIGTERM);
    while (!lifecycle.stopping()) std::this_thread::sleep_for(1ms);
    kill(getpid(), SIGINT);
    std::this_thread::sleep_for(20s);
    return 0;
  });
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 128 + SIGINT);
}

TEST_CASE("a service that something holds at its end leaves all the same, with a word") {
  for (const bool after_main :
       {false, true}) {  // iceoryx holds processes in destructors of static objects, too
    int said[2];
    REQUIRE(pipe(said) == 0);
    const int status = status_of([&] {
      dup2(said[1], STDERR_FILENO);
      auto lifecycle = std::make_unique<Lifecycle>(50ms);
      kill(getpid(), SIGTERM);
      while (!lifecycle->stopping()) std::this_thread::sleep_for(1ms);
      if (after_main) lifecycle.reset();
      std::this_thread::sleep_for(20s);
      return 1;
    });
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
    char words[200] = {};
    CHECK(read(said[0], words, sizeof words - 1) > 0);
    CHECK_THAT(words, Catch::Contains("still held by something: leaving at once"));
    close(said[0]);
    close(said[1]);
  }
}

TEST_CASE("SIGHUP ends no service: it says a word and goes on") {
  const int status = status_of([] {
    Lifecycle lifecycle(20s);
    for (int i = 0; i < 3; ++i) kill(getpid(), SIGHUP);
    if (!lifecycle.sleep_until(steady_clock::now() + 100ms)) return 1;
    kill(getpid(), SIGTERM);
    return lifecycle.sleep_until(steady_clock::now() + 20s) ? 2 : 0;
  });
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("when the lifecycle has ended a signal has its usual effect") {
  const int status = status_of([] {
    { Lifecycle lifecycle; }
    kill(getpid(), SIGTERM);
    std::this_thread::sleep_for(20s);
    return 0;
  });
  CHECK(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == SIGTERM);
}

TEST_CASE("without systemd its notifications do nothing") {
  unsetenv("NOTIFY_SOCKET");
  gvom::services::notify_ready();
  gvom::services::notify_status("well");
  gvom::services::notify_watchdog();
  gvom::services::notify_stopping();
}

TEST_CASE("LogEvery holds lines back within its period and says how many") {
  std::ostringstream out;
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_st>(out)));
  spdlog::set_pattern("%v");
  gvom::services::LogEvery log(3s);  // longer than the machine pauses between the next lines
  for (int i = 0; i < 3; ++i) log(spdlog::level::info, "line {}", i);
  std::this_thread::sleep_for(3100ms);
  log(spdlog::level::info, "line {}", 3);
  spdlog::set_default_logger(before);
  CHECK(out.str() == "line 0\nline 3 (2 more like this)\n");
}
