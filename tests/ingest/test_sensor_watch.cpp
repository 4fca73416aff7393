// What is said of a live sensor, from counters alone.
#include <catch2/catch.hpp>

#include <string>

#include "services/ingest/sensor_watch.hpp"

using namespace gvom;
using ingest::SensorWatch;
using ingest::SourceCounters;

namespace {

constexpr std::int64_t kTenth_ns = 100'000'000;

services::LidarConfig front() {
  services::LidarConfig lidar;
  lidar.name = "front";
  return lidar;
}

const services::LidarConfig kLidar = front();

/// A sensor of 640 packets and 10 sweeps of 1024 columns a second; 1280 packets at most.
class Sensor {
 public:
  /// A tenth of a second; `change` says what is not as it should be in it.
  template <class Change>
  void live(int tenths, Change change) {
    for (int i = 0; i < tenths; ++i) {
      counters_.packets += 64;
      counters_.columns += 1024;
      change(counters_);
      now_ns_ += kTenth_ns;
      watch_.update(counters_, overruns_, now_ns_);
    }
  }
  void live(int tenths) {
    live(tenths, [](SourceCounters&) {});
  }
  void overrun() { ++overruns_; }
  [[nodiscard]] std::string says() const {
    services::Words words;
    watch_.describe(words);
    CHECK(words.empty() == (watch_.faults() == 0));
    return std::string(words.text());
  }

 private:
  SourceCounters counters_;
  std::uint64_t overruns_ = 0;
  std::int64_t now_ns_ = 1'000'000'000;
  SensorWatch watch_{1280, kLidar, now_ns_};
};

/// Told within half a second, until a second after the last half-second with it.
template <class Change>
void check_told(const std::string& words, Change change) {
  Sensor sensor;
  sensor.live(20);
  CHECK(sensor.says().empty());
  sensor.live(5, change);
  CHECK(sensor.says() == words);
  sensor.live(13);
  CHECK(!sensor.says().empty());
  sensor.live(1);
  CHECK(sensor.says().empty());
}

}  // namespace

TEST_CASE("silence is told after half a second, for how long, and no longer than it lasts") {
  Sensor sensor;
  const auto silent = [](SourceCounters& counters) {
    counters.packets -= 64;
    counters.columns -= 1024;
  };
  sensor.live(10);
  sensor.live(4, silent);
  CHECK(sensor.says().empty());
  sensor.live(1, silent);
  CHECK(sensor.says() == "no packets for 0.5 s");
  sensor.live(25, silent);
  CHECK(sensor.says() == "no packets for 3.0 s");
  sensor.live(1);
  CHECK(sensor.says().empty());
}

TEST_CASE("a sensor that never sent is silent") {
  SensorWatch watch(1280, kLidar, 1'000'000'000);
  watch.update({}, 0, 3'000'000'000);
  services::Words words;
  watch.describe(words);
  CHECK(words.text() == "no packets for 2.0 s");
}

TEST_CASE("each fault is told in words and numbers") {
  check_told("31 % of packets lost", [](SourceCounters& counters) {
    counters.columns -= 317;
    counters.missing_columns += 317;
  });
  check_told("50 % of packets came again", [](SourceCounters& counters) {
    counters.packets += 64;
    counters.duplicate_packets += 64;
  });
  check_told("25 % of packets out of order", [](SourceCounters& counters) {
    counters.out_of_order_packets += 12;
    counters.late_packets += 4;
  });
  check_told("packets of a second sensor at 127.0.0.2: 120/s not used", [](SourceCounters& counters) {
    counters.packets += 12;
    counters.second_sensor_packets += 12;
    counters.second_address = ingest::parse_address("127.0.0.2").value();
  });
  check_told("packets of another model, 1206 bytes each: 600/s not used", [](SourceCounters& counters) {
    counters.packets += 60;
    counters.foreign_packets += 60;
    counters.foreign_size = 1206;
  });
  check_told("packets of another model, 1206 bytes each (a VLS-128, model byte 0xA1): 600/s not used",
             [](SourceCounters& counters) {
               counters.packets += 60;
               counters.foreign_packets += 60;
               counters.foreign_size = 1206;
               counters.foreign_kind = {"a VLS-128, model byte 0xA1"};
             });
  check_told("packets of a second sensor at 10.0.0.2 (serial number 6): 120/s not used",
             [](SourceCounters& counters) {
               counters.packets += 12;
               counters.second_sensor_packets += 12;
               counters.second_address = ingest::parse_address("10.0.0.2").value();
               counters.second_kind = {"serial number 6"};
             });
  check_told("garbage: 600 packets/s not used", [](SourceCounters& counters) {
    counters.packets += 60;
    counters.foreign_packets += 60;
    counters.foreign_size_changes += 59;
  });
  check_told("20 messages/s not used: field 't' has the unknown datatype 9", [](SourceCounters& counters) {
    counters.packets += 2;
    counters.foreign_packets += 2;
    counters.refusal = {"field 't' has the unknown datatype 9"};
  });
  check_told("70 packets/s lost in the socket's queue",
             [](SourceCounters& counters) { counters.kernel_drops += 7; });
  check_told("50 % of columns invalid", [](SourceCounters& counters) {
    counters.columns -= 512;
    counters.invalid_columns += 512;
  });
}

TEST_CASE("a cloud that max_returns cuts is told of") {
  check_told("the cloud is cut, 20480 returns/s: raise max_returns",
             [](SourceCounters& counters) { counters.overflow_returns += 2048; });
}

TEST_CASE("a flood is more than a sensor can send, and names what it consists of") {
  Sensor sensor;
  sensor.live(20);
  sensor.live(6, [](SourceCounters& counters) {
    counters.packets += 9 * 64;
    counters.duplicate_packets += 9 * 64;
  });
  CHECK(sensor.says() == "flood: 6400 packets/s, a sensor sends at most 1280; 90 % of packets came again");
}

TEST_CASE("sweeps that the loop was too slow for") {
  Sensor sensor;
  sensor.live(10);
  sensor.overrun();
  sensor.live(5);
  CHECK(sensor.says() == "2 sweeps/s dropped, waiting to be mapped");
}

TEST_CASE("a sender that is too slow for a sensor is told of, and that of the sensor nothing comes") {
  Sensor sensor;
  sensor.live(12, [tenth = 0](SourceCounters& counters) mutable {
    counters.packets -= 64;
    counters.columns -= 1024;
    if (++tenth % 2 != 0) return;
    ++counters.packets;
    ++counters.slow_packets;
    counters.slow_address = ingest::parse_address("fe80::7").value();
  });
  CHECK(sensor.says() ==
        "no packets for 1.2 s; fe80::7 sends 6 packets/s, too few for such a sensor: not used");
}

TEST_CASE("a stray packet, a few lost columns and what comes once are no faults") {
  Sensor sensor;
  sensor.live(10);
  sensor.live(1, [](SourceCounters& counters) {
    counters.foreign_packets += 2;
    counters.second_sensor_packets += 1;
    counters.missing_columns += 16;
    counters.duplicate_packets += 1;
    counters.late_packets += 1;
  });
  CHECK(sensor.says().empty());
}

TEST_CASE("of a source without packets nothing is ever said") {
  SensorWatch watch(0, kLidar, 0);
  for (std::int64_t now_ns = 0; now_ns < 5'000'000'000; now_ns += kTenth_ns) watch.update({}, 0, now_ns);
  CHECK(watch.faults() == 0);
}

TEST_CASE("a sensor's own packets beside the lidar's are no fault") {
  Sensor sensor;
  sensor.live(20, [](SourceCounters& counters) {
    counters.packets += 10;
    counters.foreign_packets += 10;  // of an IMU, to the same port
    counters.side_packets += 10;
  });
  CHECK(sensor.says().empty());
}

TEST_CASE("sweeps that are all dropped for want of columns are told, with the key that decides") {
  Sensor sensor;
  sensor.live(20, [](SourceCounters& counters) {
    ++counters.dropped_sweeps;
    counters.dropped_fractions += 1.0 / 3;
  });
  CHECK(sensor.says() ==
        "no map: its sweeps have 33 % of their columns, lidars.front.min_sweep_fraction is 0.5");
  Sensor other;
  other.live(20, [](SourceCounters& counters) {  // every second one
    ++(counters.dropped_sweeps == counters.sweeps ? counters.dropped_sweeps : counters.sweeps);
  });
  CHECK(other.says().empty());
}

TEST_CASE("sweeps of another mode or pace, and those of a sender on trial, are not said to lack columns") {
  Sensor sensor;
  sensor.live(20, [](SourceCounters& counters) { ++counters.misfit_sweeps; });
  CHECK(sensor.says() == "no map: its sweeps are of another mode or pace than lidars.front.source says");
  Sensor trial;
  trial.live(20, [](SourceCounters& counters) { ++counters.withheld_sweeps; });
  CHECK(trial.says().empty());
}
