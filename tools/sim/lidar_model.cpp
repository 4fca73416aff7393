#include "tools/sim/lidar_model.hpp"

#include <array>
#include <cmath>

#include "tools/sim/noise.hpp"

namespace gvom::sim {
namespace {

constexpr int kOusterColumns = 1024;
constexpr double kOusterTop = 22.5;                         // degrees; the lowest beam is its mirror
constexpr double kStagger[4] = {3.16, 1.05, -1.06, -3.17};  // degrees
constexpr double kOusterRise = 0.03618;                     // metres
constexpr double kScatter = 0.03;                           // degrees

// A VLP-16 fires its lasers one after the other, in this order, every 2.304 us, in sequences of 55.296 us.
// Its turn is 1800 of them, 75 whole packets: 602.8 a minute, in the range that its motor keeps to.
constexpr std::array<double, 16> kPuckAltitude{-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
constexpr int kPuckColumns = 1800;
constexpr std::int64_t kPuckColumnNs = 55'296;
constexpr int kPuckColumnsPerPacket = 24;
constexpr double kPuckLaserTurn = 0.2 * 2.304 / 55.296;  // degrees from one laser to the next

double rounded(double value) {
  return std::round(value * 1000.0) / 1000.0;
}

void make_ouster(LidarModel& lidar, int beams, int rate_hz, std::uint64_t seed) {
  lidar.columns = kOusterColumns;
  lidar.turn_ns = 1'000'000'000 / rate_hz;
  lidar.range_unit_m = 0.008;  // of profile RNG15
  lidar.beam_origin_m = 0.015806;
  // Turned by half a turn and raised, as in every OS1.
  lidar.T_sensor_lidar.linear().diagonal() = Eigen::Vector3d(-1.0, -1.0, 1.0);
  lidar.T_sensor_lidar.translation().z() = kOusterRise;
  const std::uint64_t key = derive(derive(seed, 0xBEA), static_cast<std::uint64_t>(lidar.number));
  for (int beam = 0; beam < beams; ++beam) {
    const auto scatter = [&](int axis) {
      return kScatter * (2.0 * uniform(derive(key, static_cast<std::uint64_t>(2 * beam + axis))) - 1.0);
    };
    lidar.altitude_deg.push_back(rounded(kOusterTop * (1.0 - 2.0 * beam / (beams - 1.0)) + scatter(0)));
    lidar.azimuth_deg.push_back(rounded(kStagger[beam % 4] + scatter(1)));
  }
}

void make_puck(LidarModel& lidar) {
  lidar.columns = kPuckColumns;
  lidar.turn_ns = kPuckColumns * kPuckColumnNs;
  lidar.range_unit_m = 0.002;
  lidar.beam_origin_m = 0.0;
  for (std::size_t beam = 0; beam < kPuckAltitude.size(); ++beam) {
    lidar.altitude_deg.push_back(kPuckAltitude[beam]);
    lidar.azimuth_deg.push_back(kPuckLaserTurn * static_cast<double>(beam));
  }
}

}  // namespace

tl::expected<Sensor, std::string> find_sensor(const std::string& name) {
  for (const Sensor sensor : {Sensor::os1_64, Sensor::os1_128, Sensor::vlp_16})
    if (name == name_of(sensor)) return sensor;
  return tl::unexpected(name + ": no such sensor; there are os1-64, os1-128 and vlp-16");
}

const char* name_of(Sensor sensor) {
  switch (sensor) {
    case Sensor::os1_64:
      return "os1-64";
    case Sensor::os1_128:
      return "os1-128";
    case Sensor::vlp_16:
      return "vlp-16";
  }
  return "";
}

/// A VLP-16's packets have one stamp each, in whole microseconds.
std::int64_t LidarModel::stamp_ns(int sweep, int column) const {
  const std::int64_t turn = start_ns + sweep * turn_ns;
  if (sensor != Sensor::vlp_16) return turn + column * turn_ns / columns;
  const int within = column % kPuckColumnsPerPacket;
  const std::int64_t packet = turn + (column - within) * kPuckColumnNs;
  return packet / 1000 * 1000 + within * kPuckColumnNs;
}

int LidarModel::turns_per_s() const {
  return static_cast<int>(std::lround(1e9 / static_cast<double>(turn_ns)));
}

LidarModel make_lidar(Sensor sensor, const LidarPlace& place, int rate_hz, std::uint64_t seed) {
  LidarModel lidar{};
  lidar.sensor = sensor;
  lidar.name = place.name;
  lidar.number = place.number;
  lidar.udp_port = place.udp_port;
  lidar.start_ns = place.start_ns;
  lidar.T_base_sensor = place.T_base_sensor;
  lidar.T_sensor_lidar = Eigen::Isometry3d::Identity();
  if (sensor == Sensor::vlp_16)
    make_puck(lidar);
  else
    make_ouster(lidar, sensor == Sensor::os1_128 ? 128 : 64, rate_hz, seed);
  return lidar;
}

}  // namespace gvom::sim
