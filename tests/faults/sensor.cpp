#include "tests/faults/sensor.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "ipc/planner.hpp"

namespace gvom::test {

namespace {

using namespace std::chrono_literals;
using ipc::test::Child;

constexpr int kPackets = 16;  // a frame
constexpr std::int64_t kFrame_ns = 100'000'000;
constexpr std::size_t kPacketHeader = 32;
constexpr std::size_t kColumnHeader = 12;
constexpr std::size_t kPixel = 12;

sockaddr_in loopback(std::uint16_t port, std::uint32_t host) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(0x7F000000u + host);
  return address;
}

/// Datagrams from 127.0.0.HOST.
class Sender {
 public:
  Sender(std::uint16_t port, std::uint32_t host)
      : fd_(::socket(AF_INET, SOCK_DGRAM, 0)), to_(loopback(port, 1)) {
    const sockaddr_in from = loopback(0, host);
    EXPECT(::bind(fd_, reinterpret_cast<const sockaddr*>(&from), sizeof from) == 0);
  }
  void send(const ByteVector& bytes) const {
    ::sendto(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_);
  }

 private:
  int fd_;
  sockaddr_in to_;
};

ByteVector packet_of(const OusterSensor& sensor, std::int64_t frame, int index, std::uint32_t range_mm,
                     std::uint8_t serial, std::int64_t ahead_ns) {
  const int per_packet = sensor.columns_per_packet;
  ByteVector packet = plain_packet(sensor, static_cast<int>(frame & 0xFFFF), index * per_packet, range_mm);
  packet[7] = serial;
  const std::size_t column_size = kColumnHeader + kPixel * static_cast<std::size_t>(sensor.beams);
  for (int i = 0; i < per_packet; ++i) {
    const std::int64_t time_ns =
        kDriveBegin_ns + ahead_ns + frame * kFrame_ns + (index * per_packet + i) * kFrame_ns / sensor.columns;
    std::memcpy(packet.data() + kPacketHeader + static_cast<std::size_t>(i) * column_size, &time_ns,
                sizeof time_ns);
  }
  return packet;
}

/// Sends one packet in the way that `mode` says.
class Faulty {
 public:
  Faulty(std::uint16_t port, const std::atomic<std::int64_t>& ahead_ns)
      : own_(port, 1), other_(port, 2), ahead_ns_(ahead_ns) {}

  void send(SensorMode mode, std::int64_t frame, int index) {
    const ByteVector packet = packet_of(sensor_, frame, index, 8000, 1, ahead_ns_);
    const auto second = [&] { return packet_of(sensor_, frame, index, 20000, 2, ahead_ns_); };
    switch (mode) {
      case SensorMode::well:
        return own_.send(packet);
      case SensorMode::silent:
        return;
      case SensorMode::loss:
        if (random_() % 10 >= 3) own_.send(packet);
        return;
      case SensorMode::duplicates:
        return send_often(packet, 2);
      case SensorMode::disorder:
        if (index % 2 == 0) {
          held_ = packet;
          return;
        }
        own_.send(packet);
        return own_.send(held_);
      case SensorMode::second_sensor:
        own_.send(packet);
        return other_.send(second());
      case SensorMode::second_alone:
        return other_.send(second());
      case SensorMode::second_serial:
        own_.send(packet);
        return own_.send(second());
      case SensorMode::garbage:
        own_.send(packet);
        for (int i = 0; i < 10; ++i) own_.send(garbage());
        return;
      case SensorMode::flood:
        return send_often(packet, 10);
      case SensorMode::other_model:
        return own_.send(packet_of(other_sensor(), frame, index, 20000, 3, ahead_ns_));
    }
  }

 private:
  void send_often(const ByteVector& packet, int times) const {
    for (int i = 0; i < times; ++i) own_.send(packet);
  }
  ByteVector garbage() {
    ByteVector datagram(random_() % 2000);
    for (auto& byte : datagram) byte = static_cast<std::uint8_t>(random_());
    return datagram;
  }
  static OusterSensor other_sensor() {
    OusterSensor sensor = looking_down();
    sensor.beams = 4;
    return sensor;
  }

  OusterSensor sensor_ = looking_down();
  Sender own_;
  Sender other_;
  const std::atomic<std::int64_t>& ahead_ns_;
  ByteVector held_;
  std::minstd_rand random_{1};
};

std::int64_t drive_now_ns(const Board& board) {
  return ipc::monotonic_ns() - board.begin_ns;
}

void sleep_until(const Board& board, std::int64_t drive_ns) {
  const std::int64_t left_ns = drive_ns - drive_now_ns(board);
  if (left_ns > 0) std::this_thread::sleep_for(std::chrono::nanoseconds(left_ns));
}

/// The poses of one mode.
class Poses {
 public:
  Poses() : client_(ipc::PlannerClient::connect("lab-odometry", ipc::test::kPatience).value()) {}

  void publish(OdometryMode mode, std::int64_t drive_ns) {
    if (mode == OdometryMode::silent) return;
    double x_m = 0;
    if (mode == OdometryMode::moved) x_m = kMoved_m;
    if (mode == OdometryMode::returned) x_m = kReturned_m;
    const bool broken = mode == OdometryMode::not_finite && ++count_ % 2 == 0;
    send(broken ? std::numeric_limits<double>::quiet_NaN() : x_m, drive_ns);
    if (mode == OdometryMode::backwards) send(x_m, drive_ns - 300'000'000);
  }

 private:
  void send(double x_m, std::int64_t drive_ns) {
    ipc::Odometry odometry{};
    odometry.T_odom_base.position_m[0] = x_m;
    odometry.T_odom_base.orientation_xyzw[3] = 1;
    EXPECT(client_.publish_odometry(odometry, kDriveBegin_ns + drive_ns, 1));
  }

  ipc::PlannerClient client_;
  int count_ = 0;
};

std::int64_t period_ns(OdometryMode mode) {
  if (mode == OdometryMode::fast) return 5'000'000;
  return mode == OdometryMode::slow ? 1'000'000'000 : 50'000'000;
}

/// Tells when the poses cease, and when they go on. Between both there is none.
void note_gap(Board& board, bool ceases, std::int64_t last_ns, std::int64_t next_ns) {
  if (ceases) board.gap_begin_ns = last_ns;
  board.gap_end_ns = ceases ? kNoEnd : next_ns;
}

double farthest_hit_m(const ipc::BrickMapSample& map) {
  double farthest_m = 0;
  for (const Voxel& voxel : observed_voxels(map)) {
    if (voxel.hits == 0) continue;
    const double x_m =
        (voxel.x + 0.5) * map.header().grid.resolution_m[0] - map.header().T_odom_base.position_m[0];
    const double y_m =
        (voxel.y + 0.5) * map.header().grid.resolution_m[1] - map.header().T_odom_base.position_m[1];
    farthest_m = std::max(farthest_m, std::hypot(x_m, y_m));
  }
  return farthest_m;
}

}  // namespace

void live_as_sensor(std::uint16_t port, const std::atomic<SensorMode>& mode,
                    const std::atomic<std::int64_t>& ahead_ns, const Board& board) {
  Faulty sensor(port, ahead_ns);
  std::int64_t frame = drive_now_ns(board) / kFrame_ns;
  while (true) {
    frame = std::max(frame + 1, drive_now_ns(board) / kFrame_ns);  // what it slept through, nobody sees
    for (int index = 0; index < kPackets; ++index) {
      sleep_until(board, frame * kFrame_ns + (index + 1) * kFrame_ns / kPackets);
      sensor.send(mode, frame, index);
    }
  }
}

void live_as_odometry(Board& board) {
  Poses poses;
  OdometryMode before = OdometryMode::well;
  std::int64_t last_ns = 0;
  // The vehicle stands, so that each pose is known when it is late, too: a pause makes no gap.
  for (std::int64_t next_ns = drive_now_ns(board);; next_ns += period_ns(before)) {
    sleep_until(board, next_ns);
    const OdometryMode mode = board.odometry;
    const bool was_silent = before == OdometryMode::silent;
    const bool is_silent = mode == OdometryMode::silent;
    if (was_silent && !is_silent) next_ns = drive_now_ns(board);
    if (was_silent != is_silent) note_gap(board, is_silent, last_ns, next_ns);
    poses.publish(mode, next_ns);
    if (!is_silent) last_ns = next_ns;
    board.has_pose = true;
    before = mode;
  }
}

void live_as_judge(Board& board) {
  auto runtime = ipc::Runtime::connect("lab-judge", ipc::test::kPatience).value();
  auto voxels = ipc::BrickMapSubscriber::voxel_map(runtime).value();
  auto waiter = ipc::Waiter::create(runtime);
  waiter.add(voxels);
  while (true) {
    waiter.wait(100ms);
    while (const auto map = voxels.take()) {
      const double farthest_m = farthest_hit_m(*map);
      board.farthest_m = farthest_m;
      if (farthest_m > kFarthest_m) ++board.wrong_maps;
      const std::int64_t drive_ns = map->header().header.stamp_ns - kDriveBegin_ns;
      if (drive_ns > board.gap_begin_ns && drive_ns < board.gap_end_ns) ++board.maps_in_gap;
      ++board.maps;
    }
  }
}

}  // namespace gvom::test
