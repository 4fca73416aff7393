// gvom-play: a recording's UDP payloads to this machine's (or another's) ports, as the sensor sent them, so
// that the live path is what a replay tests.
#include <cstdio>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "services/common/exit_code.hpp"
#include "services/common/lifecycle.hpp"
#include "services/ingest/bag_source.hpp"
#include "services/ingest/pcap_reader.hpp"
#include "tools/play/player.hpp"

namespace {

using namespace gvom;
using services::ExitCode;

struct Options {
  std::string file;
  std::string host = "127.0.0.1";
  std::string interface;
  std::uint16_t port = 0;
  std::vector<std::string> mapped_ports;
  play::PlayOptions play;
};

void add_options(CLI::App& app, Options& options) {
  app.set_version_flag("--version", std::string("gvom-play ") + GVOM_VERSION);
  app.add_option("file", options.file,
                 "a pcap or pcapng recording, or one packed by gzip; or a bag's packets, which need --port")
      ->type_name("FILE.pcap|bag:PATH?topic=TOPIC")
      ->required();
  app.add_option("--rate", options.play.rate, "times the recorded pace")
      ->type_name("N")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  app.add_option("--host", options.host, "where to: a name, an IPv4 or IPv6 address, a multicast group")
      ->capture_default_str();
  app.add_option("--interface", options.interface, "by which interface to a multicast group")
      ->type_name("NAME");
  auto* port = app.add_option("--port", options.port, "send everything to this port (default: as recorded)")
                   ->type_name("P")
                   ->check(CLI::Range(1, 65535));
  app.add_option("--map-port", options.mapped_ports,
                 "send what was recorded to port FROM to port TO, and nothing else; repeatable")
      ->type_name("FROM:TO")
      ->allow_extra_args(false)
      ->excludes(port);
  app.add_flag("--loop", options.play.loop, "again from the start, until SIGINT or SIGTERM");
}

bool parse_mapping(const std::string& text, play::PlayOptions& options) {
  int from = 0;
  int to = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d:%d%c", &from, &to, &rest) != 2) return false;
  if (from < 1 || from > 65535 || to < 1 || to > 65535) return false;
  options.mapped_ports[static_cast<std::uint16_t>(from)] = static_cast<std::uint16_t>(to);
  return true;
}

bool is_bag(const std::string& file) {
  return file.compare(0, 4, "bag:") == 0;
}

/// What the command line says, or the code to end with.
tl::expected<Options, ExitCode> parse(int argc, char** argv) {
  Options options;
  CLI::App app("Sends the UDP payloads of a recording at the recorded pace.", "gvom-play");
  add_options(app, options);
  app.footer(
      "Examples:\n  gvom-play os1.pcap --loop\n"
      "  gvom-play 'bag:FOLDER?topic=/ouster/lidar_packets' --port 7502");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return tl::make_unexpected(app.exit(error) == 0 ? ExitCode::ok : ExitCode::usage);
  }
  if (options.port != 0) options.play.port = options.port;
  for (const std::string& mapping : options.mapped_ports) {
    if (parse_mapping(mapping, options.play)) continue;
    std::cerr << "--map-port " << mapping << ": expected FROM:TO, ports from 1 to 65535\n";
    return tl::make_unexpected(ExitCode::usage);
  }
  if (is_bag(options.file) && options.port == 0) {
    std::cerr << "a bag does not tell the ports of its packets: say --port P\n";
    return tl::make_unexpected(ExitCode::usage);
  }
  return options;
}

void print(const play::PlaySummary& summary, const ingest::SourceState& state, double seconds) {
  using Milliseconds = std::chrono::duration<double, std::milli>;
  std::printf(
      "sent %llu packets, %.1f MB in %.2f s; %llu late (worst %.2f ms), %llu to other ports, %llu failed\n",
      static_cast<unsigned long long>(summary.packets), static_cast<double>(summary.bytes) * 1e-6, seconds,
      static_cast<unsigned long long>(summary.late), Milliseconds(summary.worst_delay).count(),
      static_cast<unsigned long long>(summary.left_out), static_cast<unsigned long long>(summary.failed));
  const ingest::SourceCounters& counters = state.counters;
  std::printf(
      "recording: %llu passes; %llu fragments, %llu datagrams incomplete, %llu frames cut short, %llu not "
      "UDP\n",
      static_cast<unsigned long long>(summary.passes), static_cast<unsigned long long>(counters.fragments),
      static_cast<unsigned long long>(counters.lost_fragments),
      static_cast<unsigned long long>(counters.truncated_packets),
      static_cast<unsigned long long>(counters.foreign_packets));
  for (const std::string& warning : state.warnings) std::fprintf(stderr, "gvom-play: %s\n", warning.c_str());
}

ExitCode fail(const std::string& message, ExitCode code) {
  std::cerr << "gvom-play: " << message << "\n";
  return code;
}

tl::expected<std::unique_ptr<ingest::PacketSource>, std::string> open(const std::string& file,
                                                                      ingest::SourceState& state) {
  if (is_bag(file)) return ingest::open_bag_packets(file, state);
  return ingest::PcapReader::open(file, std::nullopt, state);
}

ExitCode run(int argc, char** argv) {
  services::Lifecycle lifecycle;
  const auto options = parse(argc, argv);
  if (!options) return options.error();
  ingest::SourceState state;
  auto recording = open(options->file, state);
  if (!recording) return fail(recording.error(), ExitCode::bad_data);
  auto sender = play::UdpSender::open(options->host, options->interface);
  if (!sender) return fail(sender.error(), ExitCode::unavailable);

  const auto start = std::chrono::steady_clock::now();
  const auto summary =
      play::play(**recording, *sender, options->play, [&](auto due) { return lifecycle.sleep_until(due); });
  if (!summary) return fail(summary.error(), ExitCode::bad_data);
  print(*summary, state, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  if (summary->packets == 0 && !lifecycle.stopping())
    return fail(options->file + ": nothing to send in it", ExitCode::bad_data);
  return ExitCode::ok;
}

}  // namespace

int main(int argc, char** argv) {
  return to_int(run(argc, argv));
}
