// The other nodes of a robot, in a process that is not ours: a driver with odometry, and who looks at the
// map. By Fast DDS, until SIGTERM; then one line for each topic says what came or went.
//   dds_robot DOMAIN drive POINTS RATE_HZ [tf]  sends /points (x, y, z, t, ring) and, at 50 Hz, /odom, or /tf
//                                               of base_footprint, on which /tf_static says base_link stands
//   dds_robot DOMAIN look TOPIC=TYPE...         reads them as RViz does; names as ROS has them
#include <signal.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <thread>

#include "tests/dds/fast_dds.hpp"
#include "tests/support/ros_messages.hpp"

namespace {

using namespace gvom::dds::test;
using namespace std::chrono_literals;

constexpr double kSpeed_mps = 1;
constexpr double kSensorHeight_m = 1.7;
constexpr unsigned kBeams = 64;
constexpr std::size_t kStampAt = 4;  // in a message: behind CDR's head

volatile sig_atomic_t stopped = 0;

std::int64_t wall_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// One turn over flat ground and a wall around it at 30 m.
gvom::test::Octets make_cloud(unsigned points, double turn_s) {
  constexpr std::uint32_t kPointBytes = 32;
  constexpr double kWall_m = 30, kLowest_rad = -0.43, kHighest_rad = 0.05, kTurn_rad = 2 * M_PI;
  gvom::test::Octets data(std::size_t{kPointBytes} * points);
  for (unsigned i = 0; i < points; ++i) {
    const auto ring = static_cast<std::uint16_t>(i % kBeams);
    const double elevation_rad = kLowest_rad + (kHighest_rad - kLowest_rad) * ring / (kBeams - 1);
    const double turned = static_cast<double>(i / kBeams) * kBeams / points;
    const double ground_m =
        elevation_rad < 0 ? std::min(kWall_m, kSensorHeight_m / std::tan(-elevation_rad)) : kWall_m;
    const float xyz[3] = {static_cast<float>(ground_m * std::cos(kTurn_rad * turned)),
                          static_cast<float>(ground_m * std::sin(kTurn_rad * turned)),
                          static_cast<float>(ground_m * std::tan(elevation_rad))};
    const auto time_ns = static_cast<std::uint32_t>(turned * turn_s * 1e9);
    std::uint8_t* const point = data.data() + std::size_t{kPointBytes} * i;
    std::memcpy(point, xyz, sizeof xyz);
    std::memcpy(point + 20, &time_ns, sizeof time_ns);
    std::memcpy(point + 24, &ring, sizeof ring);
  }
  constexpr std::uint8_t kUint16 = 4, kUint32 = 6, kFloat32 = 7;
  return gvom::test::cloud_message(0,
                                   {{{"x", 0, kFloat32},
                                     {"y", 4, kFloat32},
                                     {"z", 8, kFloat32},
                                     {"t", 20, kUint32},
                                     {"ring", 24, kUint16}},
                                    kPointBytes},
                                   data);
}

void set_stamp(gvom::test::Octets& message, std::int64_t stamp_ns) {
  const auto second = static_cast<std::int32_t>(stamp_ns / 1'000'000'000);
  const auto ns = static_cast<std::uint32_t>(stamp_ns % 1'000'000'000);
  std::memcpy(message.data() + kStampAt, &second, sizeof second);
  std::memcpy(message.data() + kStampAt + sizeof second, &ns, sizeof ns);
}

class Publisher {
 public:
  Publisher(fast::DomainParticipant* participant, const std::string& topic, const std::string& type,
            bool latched = false)
      : topic_(topic),
        writer_(make_writer(participant, open_topic(participant, new RawType(type), type, "rt" + topic),
                            &mouth_, latched)) {}

  /// Until somebody listens.
  void meet() const {
    fast::PublicationMatchedStatus status;
    do {
      std::this_thread::sleep_for(20ms);
      writer_->get_publication_matched_status(status);
    } while (status.current_count == 0 && !stopped);
  }

  void send(gvom::test::Octets& message) { ++(writer_->write(&message) ? sent_ : refused_); }
  void tell() const { say("%s sent %llu refused %llu", topic_.c_str(), sent_, refused_); }

 private:
  std::string topic_;
  Mouth mouth_;
  fast::DataWriter* writer_;
  unsigned long long sent_ = 0;
  unsigned long long refused_ = 0;
};

/// Calls `send` so often, until a SIGTERM.
template <typename Send>
void at_rate(double rate_hz, Send send) {
  const auto begin = std::chrono::steady_clock::now();
  for (long long tick = 0; !stopped; ++tick) {
    send();
    std::this_thread::sleep_until(begin + std::chrono::nanoseconds(static_cast<long long>(
                                              1e9 * static_cast<double>(tick + 1) / rate_hz)));
  }
}

gvom::test::Octets transform(const char* parent, const char* child, std::int64_t stamp_ns, double x_m) {
  return gvom::test::tf_message({{parent, child, stamp_ns, {x_m, 0, 0}}});
}

void drive(fast::DomainParticipant* participant, unsigned points, double rate_hz, bool by_tf) {
  constexpr double kOdometry_hz = 50;
  const std::string tf_type = "tf2_msgs::msg::dds_::TFMessage_";
  Publisher poses(participant, by_tf ? "/tf" : "/odom", by_tf ? tf_type : "nav_msgs::msg::dds_::Odometry_");
  Publisher standing(participant, "/tf_static", tf_type, true);
  auto mount = transform("base_footprint", "base_link", 0, 0);
  standing.send(mount);
  Publisher clouds(participant, "/points", "sensor_msgs::msg::dds_::PointCloud2_");
  poses.meet();
  clouds.meet();
  const std::int64_t begin_ns = wall_ns();
  std::thread odometry([&] {
    at_rate(kOdometry_hz, [&] {
      const std::int64_t stamp_ns = wall_ns();
      const double x_m = kSpeed_mps * 1e-9 * static_cast<double>(stamp_ns - begin_ns);
      auto pose = by_tf ? transform("odom", "base_footprint", stamp_ns, x_m)
                        : gvom::test::odometry_message(stamp_ns, x_m);
      poses.send(pose);
    });
  });
  auto cloud = make_cloud(points, 1 / rate_hz);
  say("ready");
  // A cloud begins a turn before it is sent.
  at_rate(rate_hz, [&] {
    set_stamp(cloud, wall_ns() - static_cast<std::int64_t>(1e9 / rate_hz));
    say("sending");
    clouds.send(cloud);
  });
  odometry.join();
  poses.tell();
  clouds.tell();
}

/// Counts what comes of one topic, and by the writer's numbers what does not.
class Counter : public fast::DataReaderListener {
 public:
  explicit Counter(std::string topic) : topic_(std::move(topic)) {}

  void on_data_available(fast::DataReader* reader) override {
    Bytes message;
    fast::SampleInfo info;
    while (reader->take_next_sample(&message, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      const auto number = static_cast<long long>(info.sample_identity.sequence_number().to64long());
      if (received_ > 0 && number > newest_) missing_ += number - newest_ - 1;
      newest_ = number;
      ++received_;
      bytes_ += message.size();
      say("got %s %lld", topic_.c_str(), number);
    }
  }
  void on_subscription_matched(fast::DataReader*, const fast::SubscriptionMatchedStatus& status) override {
    say("matched %d %s", status.current_count, topic_.c_str());
  }
  void tell() const {
    say("%s received %llu missing %lld bytes %llu", topic_.c_str(), received_, missing_, bytes_);
  }

 private:
  std::string topic_;
  unsigned long long received_ = 0;
  unsigned long long bytes_ = 0;
  long long newest_ = 0;
  long long missing_ = 0;
};

/// "nav_msgs::msg::dds_::Path_" for "nav_msgs/msg/Path".
std::string on_wire(const std::string& type) {
  const std::size_t slash = type.find('/');
  return type.substr(0, slash) + "::msg::dds_::" + type.substr(type.rfind('/') + 1) + "_";
}

void look(fast::DomainParticipant* participant, int count, char** topics) {
  std::deque<Counter> counters;
  for (int i = 0; i < count; ++i) {
    const std::string both = topics[i];
    const std::string topic = both.substr(0, both.find('='));
    const std::string type = on_wire(both.substr(both.find('=') + 1));
    counters.emplace_back(topic);
    const bool latched = type.find("OccupancyGrid") != std::string::npos;
    hear(participant, open_topic(participant, new RawType(type), type, "rt" + topic), latched,
         &counters.back());
  }
  say("ready");
  while (!stopped) std::this_thread::sleep_for(20ms);
  for (const Counter& counter : counters) counter.tell();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 64;
  struct sigaction action {};
  action.sa_handler = [](int) { stopped = 1; };
  ::sigaction(SIGTERM, &action, nullptr);
  fast::DomainParticipant* const participant = join(std::atoi(argv[1]));
  if (participant == nullptr) return 69;
  const std::string mode = argv[2];
  if (mode == "drive" && argc >= 5)
    drive(participant, static_cast<unsigned>(std::atoi(argv[3])), std::atof(argv[4]), argc > 5);
  else if (mode == "look")
    look(participant, argc - 3, argv + 3);
  else
    return 64;
  std::_Exit(0);
}
