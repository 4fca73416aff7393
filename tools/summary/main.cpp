// gvom-summary: listens to a run of the service graph, and says at its end what came of it.
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "ipc/fixed.hpp"
#include "ipc/layers.hpp"
#include "ipc/waiter.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/cli.hpp"
#include "services/common/log.hpp"
#include "tools/summary/report.hpp"

namespace {

using namespace gvom;
using services::ExitCode;

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::chrono::milliseconds kLongestWait{100};

struct Silent {  // a process that publishes no Health
  std::string name;
  std::uint32_t pid;
};

struct Options {
  std::string json;
  std::vector<std::string> also;
  bool progress = false;
};

std::optional<Silent> parse_also(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return std::nullopt;
  const std::string number = text.substr(equals + 1);
  if (number.empty() || number.size() > 9 || number.find_first_not_of("0123456789") != std::string::npos)
    return std::nullopt;
  return Silent{text.substr(0, equals), static_cast<std::uint32_t>(std::stoul(number))};
}

/// Says once a second on a terminal, and every five elsewhere, how far the run is.
class Progress {
 public:
  explicit Progress(bool wanted) : wanted_(wanted), terminal_(isatty(STDOUT_FILENO) == 1) {}

  void show(const summary::RunRecord& record, std::int64_t now_ns) {
    if (!wanted_ || record.layers_read() == 0 || now_ns < next_ns_) return;
    next_ns_ = now_ns + (terminal_ ? 1 : 5) * kSecond_ns;
    std::printf(terminal_ ? "\r%s\033[K" : "%s\n", summary::progress_line(record).c_str());
    std::fflush(stdout);
  }

  void end() const {
    if (wanted_ && terminal_) std::printf("\r\033[K");
  }

 private:
  bool wanted_;
  bool terminal_;
  std::int64_t next_ns_ = 0;
};

class Listener {
 public:
  Listener(ipc::Subscriber<ipc::Health> health, ipc::LayersSubscriber layers, std::vector<Silent> silent)
      : health_(std::move(health)), layers_(std::move(layers)), silent_(std::move(silent)) {}

  void add_to(ipc::Waiter& waiter) {
    waiter.add(health_);
    waiter.add(layers_);
  }

  void take(std::int64_t now_ns) {
    while (const auto layers = layers_.take()) record_.add(layers->header());
    while (const auto health = health_.take())
      record_.add(**health, tools::read_usage((*health)->pid), now_ns);
    record_.set_layers_lost(layers_.counters().lost);
    for (const auto& refusal : {layers_.new_refusal(), health_.new_refusal()})
      if (refusal) spdlog::warn("{}", *refusal);
    if (now_ns < next_look_ns_) return;
    next_look_ns_ = now_ns + kSecond_ns;
    look_at_silent(now_ns);
  }

  void look_at_silent(std::int64_t now_ns) {
    for (const Silent& process : silent_)
      if (const auto usage = tools::read_usage(process.pid))
        record_.add(process.name, process.pid, *usage, now_ns);
  }

  [[nodiscard]] const summary::RunRecord& record() const { return record_; }

 private:
  ipc::Subscriber<ipc::Health> health_;
  ipc::LayersSubscriber layers_;
  std::vector<Silent> silent_;
  summary::RunRecord record_;
  std::int64_t next_look_ns_ = 0;
};

ExitCode say(const summary::RunRecord& record, const std::string& json_path) {
  std::printf("\n%s", summary::report(record).c_str());
  std::fflush(stdout);
  if (json_path.empty()) return ExitCode::ok;
  std::ofstream file(json_path);
  file << summary::to_json(record);
  file.close();
  if (file) return ExitCode::ok;
  spdlog::error("{}: cannot be written", json_path);
  return ExitCode::unavailable;
}

ExitCode listen(ipc::Runtime& runtime, const Options& options, services::Lifecycle& lifecycle) {
  auto health = ipc::Subscriber<ipc::Health>::open(runtime);
  auto layers = ipc::LayersSubscriber::open(runtime);
  auto waiter = ipc::Waiter::create(runtime);
  for (const ipc::Error* error : {health ? nullptr : &health.error(), layers ? nullptr : &layers.error()}) {
    if (error == nullptr) continue;
    spdlog::error("{}", error->message);
    return services::exit_code_of(*error);
  }
  std::vector<Silent> silent;
  for (const std::string& text : options.also) silent.push_back(parse_also(text).value());  // checked by CLI
  Listener listener(std::move(*health), std::move(*layers), std::move(silent));
  listener.add_to(waiter);
  lifecycle.on_stop([&waiter] { waiter.wake(); });
  Progress progress(options.progress);
  while (!lifecycle.stopping() && runtime.broker_alive()) {
    waiter.wait(kLongestWait);
    const std::int64_t now_ns = ipc::monotonic_ns();
    listener.take(now_ns);
    progress.show(listener.record(), now_ns);
  }
  lifecycle.on_stop({});
  listener.take(ipc::monotonic_ns());
  progress.end();
  const ExitCode said = say(listener.record(), options.json);
  if (runtime.broker_alive()) return said;
  spdlog::critical("the broker is gone");
  _exit(to_int(ExitCode::try_again));  // destructors of ports without a broker can hang
}

}  // namespace

int main(int argc, char** argv) {
  services::Lifecycle lifecycle;
  services::Cli cli("gvom-summary",
                    "Listens to all processes until SIGTERM, then says what came of the run.");
  Options options;
  cli.app().add_option("--json", options.json, "the figures for scripts, too")->type_name("FILE");
  cli.app()
      .add_option("--also", options.also, "a process that reports nothing itself; repeatable")
      ->type_name("NAME=PID")
      ->allow_extra_args(false)
      ->check([](const std::string& text) { return parse_also(text) ? "" : "expected NAME=PID"; });
  cli.app().add_flag("--progress", options.progress, "say meanwhile how far it is");
  cli.app().footer("Example:\n  gvom-summary --config vehicle.yaml --json figures.json");
  const auto config = cli.parse(argc, argv);
  if (!config) return services::to_int(config.error());
  services::init_logging("gvom-summary");
  auto runtime = services::join_bus("gvom-summary", lifecycle);
  if (!runtime) return services::to_int(runtime.error());
  return services::to_int(listen(*runtime, options, lifecycle));
}
