// gvom-test-vehicle RECORDING FOLDER NAME:PORT...: a vehicle that stands still, live. One sweep of each lidar
// of a recording is sent to its port at 20 Hz (or each GVOM_TURN_MS), over and over with new times, and the
// pose is published on the bus. It is a planner, too: FOLDER/layers and FOLDER/window tell when (Unix time,
// ms) it got its first layers, and its first of a full window.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "ipc/planner.hpp"
#include "services/common/exit_code.hpp"
#include "services/common/lifecycle.hpp"
#include "services/ingest/bytes.hpp"
#include "services/ingest/ouster_format.hpp"
#include "services/ingest/pcap_reader.hpp"

namespace {

using namespace gvom;
using namespace std::chrono_literals;
using services::ExitCode;
using std::chrono::steady_clock;
using Datagram = std::vector<std::uint8_t>;

constexpr std::size_t kFrameId = 2;  // in a packet of RNG15_RFL8_NIR8, gvom-sim's
constexpr std::size_t kColumns = 16;
constexpr int kAtOnce = 4;  // packets, as they come through a switch
constexpr auto kPosePeriod = 20ms;
constexpr std::uint32_t kFull = 8;  // maps of each lidar: window.buffer_size

std::int64_t turn_ns() {
  static const char* const set_ms = std::getenv("GVOM_TURN_MS");
  return (set_ms != nullptr ? std::atoi(set_ms) : 50) * std::int64_t{1'000'000};
}

/// The second sweep of a recording: the first whole one. Empty if there is none.
std::vector<Datagram> read_sweep(const std::string& path) {
  ingest::SourceState state;
  auto reader = ingest::PcapReader::open(path, std::nullopt, state);
  if (!reader) return {};
  std::vector<Datagram> sweep;
  std::uint16_t first_frame = 0;
  ingest::Packet packet;
  for (int count = 0;; ++count) {
    const auto event = (*reader)->next(packet, 0ms);
    if (!event || *event != ingest::PacketEvent::packet) return sweep;
    const auto frame = ingest::load_le<std::uint16_t>(packet.data + kFrameId);
    if (count == 0) first_frame = frame;
    if (frame == static_cast<std::uint16_t>(first_frame + 1))
      sweep.emplace_back(packet.data, packet.data + packet.size);
    if (frame == static_cast<std::uint16_t>(first_frame + 2)) return sweep;
  }
}

/// Gives a packet the number of its turn and its columns the times they have in it.
void redate(Datagram& packet, std::int64_t turn, std::size_t index, std::size_t packets) {
  const ingest::OusterLayout layout = *ingest::find_ouster_layout("RNG15_RFL8_NIR8");
  const auto frame = static_cast<std::uint16_t>(turn);
  std::memcpy(packet.data() + kFrameId, &frame, sizeof frame);
  const std::size_t column_size = (packet.size() - layout.packet_header - layout.packet_footer) / kColumns;
  for (std::size_t i = 0; i < kColumns; ++i) {
    const auto part = static_cast<std::int64_t>(index * kColumns + i);
    const std::int64_t time_ns =
        turn * turn_ns() + part * turn_ns() / static_cast<std::int64_t>(packets * kColumns);
    std::memcpy(packet.data() + layout.packet_header + i * column_size, &time_ns, sizeof time_ns);
  }
}

[[noreturn]] void live_as_lidar(std::vector<Datagram> sweep, std::uint16_t port) {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::int64_t turn = ipc::monotonic_ns() / turn_ns();
  while (true) {
    turn = std::max(turn + 1, ipc::monotonic_ns() / turn_ns());  // what it slept through, nobody sees
    for (std::size_t i = 0; i < sweep.size(); ++i) {
      if (i % kAtOnce == 0) {
        const auto share = static_cast<std::int64_t>(i + kAtOnce) * turn_ns();
        const std::int64_t due_ns = turn * turn_ns() + share / static_cast<std::int64_t>(sweep.size());
        std::this_thread::sleep_for(std::chrono::nanoseconds(due_ns - ipc::monotonic_ns()));
      }
      redate(sweep[i], turn, i, sweep.size());
      ::sendto(fd, sweep[i].data(), sweep[i].size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    }
  }
}

/// Tells the time in a file, all or nothing.
void note_time(const std::string& path) {
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  std::ofstream(path + ".new") << std::chrono::duration_cast<std::chrono::milliseconds>(since).count()
                               << "\n";
  std::rename((path + ".new").c_str(), path.c_str());
}

class Planner {
 public:
  Planner(ipc::PlannerClient client, std::string folder)
      : client_(std::move(client)), folder_(std::move(folder)) {}

  ExitCode drive(services::Lifecycle& lifecycle) {
    for (auto next = steady_clock::now(); lifecycle.sleep_until(next); next += kPosePeriod) {
      ipc::Odometry odometry{};
      odometry.T_odom_base.orientation_xyzw[3] = 1;
      if (!client_.publish_odometry(odometry, ipc::monotonic_ns(), 1)) return ExitCode::internal;
      const auto layers = client_.newest_layers(0ms);
      if (layers) look_at(layers->header());
      if (!layers && layers.error().kind == ipc::ErrorKind::unavailable) ::_exit(to_int(ExitCode::try_again));
    }
    return ExitCode::ok;
  }

 private:
  void look_at(const ipc::Layers& layers) {
    if (layers_++ == 0) note_time(folder_ + "/layers");
    bool full = layers.lidar_count > 0 && !told_full_;
    for (std::uint32_t i = 0; i < layers.lidar_count; ++i)
      full = full && layers.lidars[i].maps_in_window >= kFull;
    if (!full) return;
    told_full_ = true;
    note_time(folder_ + "/window");
  }

  ipc::PlannerClient client_;
  std::string folder_;
  std::uint64_t layers_ = 0;
  bool told_full_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  services::Lifecycle lifecycle;
  if (argc < 4) return to_int(ExitCode::usage);
  const std::string recording = argv[1];
  std::vector<std::thread> lidars;
  for (int i = 3; i < argc; ++i) {
    const std::string lidar = argv[i];
    const std::size_t colon = lidar.find(':');
    if (colon == std::string::npos) return to_int(ExitCode::usage);
    auto sweep = read_sweep(recording + "/" + lidar.substr(0, colon) + ".pcap");
    if (sweep.empty()) return to_int(ExitCode::bad_data);
    const auto port = static_cast<std::uint16_t>(std::stoi(lidar.substr(colon + 1)));
    std::thread(live_as_lidar, std::move(sweep), port).detach();
  }
  auto client = ipc::PlannerClient::connect("gvom-test-vehicle", 10s);
  if (!client) {
    std::fprintf(stderr, "%s\n", client.error().message.c_str());
    return to_int(ExitCode::try_again);
  }
  services::notify_ready();
  return to_int(Planner(std::move(*client), argv[2]).drive(lifecycle));
}
