#include "tools/endurance/feeder.hpp"

#include <cstdio>
#include <cstring>
#include <random>
#include <thread>

#include "ipc/runtime.hpp"
#include "services/common/exit_code.hpp"
#include "tools/endurance/channel.hpp"
#include "tools/play/udp_sender.hpp"

namespace gvom::endurance {

namespace {

constexpr std::int64_t kLatestBegin_ns = 300'000'000;  // a round that is older is begun in its middle
constexpr std::chrono::milliseconds kLook{1};          // for the next round
constexpr std::size_t kFrameAt = 2;
constexpr std::size_t kLongestGarbage = 2000;

class Feeder {
 public:
  Feeder(Recording recording, const std::vector<std::uint16_t>& ports, const Board& board, int socket,
         play::UdpSender sender)
      : recording_(std::move(recording)),
        ports_(ports),
        board_(board),
        socket_(socket),
        sender_(std::move(sender)) {}

  /// Sends one round, if one begins now. False if nobody reads our notes.
  bool step() {
    const std::uint64_t epoch = board_.epoch;
    const std::int64_t begin_ns = board_.begin_ns;
    const bool late = ipc::monotonic_ns() - begin_ns > kLatestBegin_ns;
    const bool may_be_late = epoch_ != 0;  // not in the very first round
    if (epoch == epoch_ || board_.hold || (late && !may_be_late)) {
      std::this_thread::sleep_for(kLook);
      return true;
    }
    epoch_ = epoch;
    if (!tell(NoteKind::round_begin, 0)) return false;
    const std::int64_t from_ns = late ? ipc::monotonic_ns() - begin_ns : 0;
    skip_frames(from_ns);
    const bool whole = send_round(begin_ns, from_ns) && !late;
    first_frame_ = next_frame_;
    return tell(NoteKind::round_end, whole ? 1 : 0);
  }

 private:
  bool send_round(std::int64_t begin_ns, std::int64_t from_ns) {
    for (TimedPacket& packet : recording_.packets) {
      if (packet.due_ns < from_ns) continue;
      while (true) {
        const std::int64_t left_ns = begin_ns + packet.due_ns - ipc::monotonic_ns();
        if (board_.epoch != epoch_) return false;
        if (left_ns <= 0) break;
        std::this_thread::sleep_for(std::chrono::nanoseconds(std::min<std::int64_t>(left_ns, 10'000'000)));
      }
      send(packet);
    }
    return true;
  }

  /// Whoever begins in the middle counts from there.
  void skip_frames(std::int64_t from_ns) {
    PerLidar<bool> seen{};
    for (const TimedPacket& packet : recording_.packets) {
      if (packet.due_ns < from_ns || seen[packet.lidar]) continue;
      seen[packet.lidar] = true;
      first_frame_[packet.lidar] = static_cast<std::uint16_t>(first_frame_[packet.lidar] - packet.frame);
    }
  }

  // Frames go on counting over the rounds, as those of a sensor that keeps turning.
  void send(TimedPacket& packet) {
    const auto frame = static_cast<std::uint16_t>(first_frame_[packet.lidar] + packet.frame);
    next_frame_[packet.lidar] = static_cast<std::uint16_t>(frame + 1);
    std::memcpy(packet.bytes.data() + kFrameAt, &frame, sizeof frame);
    const SendMode mode = board_.modes[packet.lidar];
    if (mode == SendMode::silent || (mode == SendMode::loss && random_() % 10 < 3)) return;
    transmit(packet.lidar, packet.bytes.data(), packet.bytes.size());
    for (int i = 0; mode == SendMode::garbage && i < 10; ++i) {
      std::vector<std::uint8_t> bytes(1 + random_() % kLongestGarbage);
      for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random_());
      transmit(packet.lidar, bytes.data(), bytes.size());
    }
  }

  void transmit(std::uint32_t lidar, const std::uint8_t* data, std::size_t size) {
    if (sender_.send(data, size, ports_[lidar])) ++sent_[lidar];
  }

  bool tell(NoteKind kind, std::uint64_t whole) const {
    return send_note(socket_, kind, RoundNote{epoch_, ipc::monotonic_ns(), whole, sent_});
  }

  Recording recording_;
  const std::vector<std::uint16_t>& ports_;
  const Board& board_;
  int socket_;
  play::UdpSender sender_;
  std::uint64_t epoch_ = 0;
  PerLidar<std::uint16_t> first_frame_{};  // of the round
  PerLidar<std::uint16_t> next_frame_{};
  PerLidar<std::uint64_t> sent_{};
  std::minstd_rand random_{1};
};

}  // namespace

int feed_packets(Recording recording, const std::vector<std::uint16_t>& ports, const Board& board,
                 int socket) {
  auto sender = play::UdpSender::open("127.0.0.1");
  if (!sender) {
    std::fprintf(stderr, "gvom-soak: %s\n", sender.error().c_str());
    return to_int(services::ExitCode::unavailable);
  }
  Feeder feeder(std::move(recording), ports, board, socket, std::move(*sender));
  while (feeder.step()) {
  }
  return to_int(services::ExitCode::ok);
}

}  // namespace gvom::endurance
