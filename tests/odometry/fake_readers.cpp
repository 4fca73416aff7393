#include "tests/odometry/fake_readers.hpp"

#include <cstring>
#include <optional>
#include <thread>

#include "ipc/fixed.hpp"
#include "ipc/runtime.hpp"

using namespace gvom::ipc;
using namespace gvom::ipc::test;

namespace gvom::test {
namespace {

/// The bus's ends of a reader; in a child.
class FakeReader {
 public:
  explicit FakeReader(const std::string& name)
      : name_(name),
        runtime_(Runtime::connect("fake-" + name, kPatience).value()),
        progress_(Publisher<Progress>::open(runtime_).value()),
        odometry_(Subscriber<Odometry>::open(runtime_).value()) {
    message_.lidar_count = 2;
    std::strcpy(message_.reader, name.c_str());
    std::strcpy(message_.taken[0].lidar, "front");
    std::strcpy(message_.taken[1].lidar, "rear");
  }

  std::optional<Sample<Odometry>> take() { return odometry_.take(); }

  void publish(std::uint64_t odometry_sequence, std::uint64_t epoch, std::uint64_t maps = 0) {
    message_.odometry_sequence = odometry_sequence;
    message_.maps_published = maps;
    for (auto& taken : message_.taken) taken.sequence = maps;
    EXPECT(progress_.publish(message_, 0, epoch));
  }

 private:
  std::string name_;
  Runtime runtime_;
  Publisher<Progress> progress_;
  Subscriber<Odometry> odometry_;
  Progress message_{};
};

}  // namespace

std::function<void()> fusion(const Step& done, std::uint64_t maps) {
  return [&done, maps] {
    FakeReader reader("fusion");
    while (!done.reached(1)) {
      reader.publish(0, 0, maps);
      std::this_thread::sleep_for(5ms);
    }
  };
}

std::function<void()> lossless_ingest(const std::string& name, const Step& done,
                                      std::chrono::milliseconds pause, std::uint64_t poses) {
  return [=, &done] {
    FakeReader reader(name);
    std::uint64_t last = 0;
    std::uint64_t epoch = 0;
    bool ended = false;
    double last_x_m = 0;
    while (!done.reached(1)) {
      reader.publish(last, epoch, ended ? 7 : 0);
      const auto odometry = reader.take();
      if (!odometry) {
        std::this_thread::sleep_for(1ms);
        continue;
      }
      EXPECT(!ended);
      EXPECT((*odometry)->header.sequence == last + 1);
      EXPECT((*odometry)->flags & Odometry::kLossless);
      ended = ((*odometry)->flags & Odometry::kEndOfStream) != 0;
      EXPECT(!ended || (*odometry)->T_odom_base.position_m[0] == last_x_m);
      EXPECT(ended == ((*odometry)->header.sequence == poses + 1));
      last = (*odometry)->header.sequence;
      epoch = (*odometry)->header.epoch;
      last_x_m = (*odometry)->T_odom_base.position_m[0];
      std::this_thread::sleep_for(pause);
    }
    EXPECT(ended);
  };
}

std::function<void()> ingest(const std::string& name, const Step& done, std::uint64_t until, Step* joined) {
  return [=, &done] {
    FakeReader reader(name);
    std::uint64_t last = 0;
    std::uint64_t epoch = 0;
    while (!done.reached(1)) {
      while (const auto odometry = reader.take()) {
        if (until == 0 || (*odometry)->header.sequence <= until) last = (*odometry)->header.sequence;
        epoch = (*odometry)->header.epoch;
      }
      reader.publish(last, epoch);
      if (joined != nullptr) joined->reach(1);
      std::this_thread::sleep_for(2ms);
    }
  };
}

}  // namespace gvom::test
