#include <spdlog/spdlog.h>

#include "ipc/runtime.hpp"
#include "tools/ctl/bus_watch.hpp"
#include "tools/ctl/commands.hpp"
#include "tools/ctl/http_server.hpp"
#include "tools/ctl/render.hpp"

namespace gvom::ctl {

namespace {

constexpr std::chrono::milliseconds kServeFor{50};

tl::expected<boost::asio::ip::tcp::endpoint, std::string> endpoint_of(const MetricsOptions& options) {
  auto endpoint = parse_endpoint(options.listen);
  if (!endpoint || endpoint->address().is_loopback() || options.remote) return endpoint;
  return tl::unexpected(
      options.listen +
      ": others than this machine would be let in, without a password: say --remote if you mean that");
}

}  // namespace

int serve_metrics(const Watched& watched, const MetricsOptions& options) {
  const auto endpoint = endpoint_of(options);
  if (!endpoint) {
    spdlog::error("{}", endpoint.error());
    return to_int(services::ExitCode::usage);
  }
  BusWatch watch;
  const auto text = [&] {
    return to_prometheus(
        assess(watch.broker(), watch.observed(), watched.expected, watched.surroundings, ipc::Moment::now()));
  };
  const auto server = HttpServer::open(*endpoint, "/metrics", text);
  if (!server) {
    spdlog::error("{}", server.error());
    return to_int(services::ExitCode::unavailable);
  }
  const auto bound = (*server)->endpoint();
  spdlog::info("metrics at http://{}:{}/metrics", bound.address().to_string(), bound.port());
  services::notify_ready();
  while (!watched.lifecycle.stopping()) {
    watch.step(std::chrono::milliseconds(0));
    (*server)->run_for(kServeFor);
    services::notify_watchdog();
  }
  services::notify_stopping();
  return to_int(services::ExitCode::ok);
}

}  // namespace gvom::ctl
