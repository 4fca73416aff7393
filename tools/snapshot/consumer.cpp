#include "tools/snapshot/consumer.hpp"

#include <algorithm>
#include <limits>

#include "ipc/text.hpp"
#include "services/common/log.hpp"

namespace gvom::snapshot {
namespace {

using services::ExitCode;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kSilenceCheck{500};  // how soon a lost broker is seen

double seconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

/// Keeps the newest layers and writes them when asked.
class Consumer {
 public:
  Consumer(ipc::PlannerClient& client, const std::string& vehicle, Output& output)
      : client_(client), vehicle_(vehicle), output_(output) {}

  /// Waits up to `timeout` for newer layers. False: the broker is gone.
  bool refresh(std::chrono::milliseconds timeout) {
    auto sample = client_.newest_layers(timeout, ipc::kAnyAge);  // it shows how old they are
    while (const auto refusal = client_.new_refusal()) spdlog::warn("{}", *refusal);
    if (sample) {
      newest_.emplace(std::move(*sample));
      unwritten_ = true;
    } else if (sample.error().kind != ipc::ErrorKind::timeout) {
      spdlog::error("{}", sample.error().message);
      return false;
    }
    return true;
  }

  [[nodiscard]] bool has_unwritten() const { return unwritten_; }

  bool write() {
    const LayersPicture picture = picture_of(*newest_, vehicle_);
    const auto written = output_.write(picture);
    if (!written) {
      spdlog::error("{}", written.error());
      return false;
    }
    unwritten_ = false;
    const ipc::InCounters& counters = client_.counters();
    spdlog::info("picture {} in {}: stamp {:.3f} s, age {:.3f} s, {} layers taken, {} lost, {} refused",
                 output_.written(), output_.folder(), static_cast<double>(picture.stamp_ns) * 1e-9,
                 picture.age_s, counters.received, counters.lost, counters.refused());
    if (picture.age_s > seconds(ipc::kDefaultMaxAge))
      spdlog::warn("the layers in it are {}", ipc::age_words(newest_->age()));
    for (const LidarLine& lidar : picture.lidars)
      if (lidar.missing) spdlog::warn("lidar {} is missing", lidar.name);
    return true;
  }

 private:
  ipc::PlannerClient& client_;
  const std::string& vehicle_;
  Output& output_;
  std::optional<ipc::LayersSample> newest_;
  bool unwritten_ = false;
};

ExitCode consume_first(Consumer& consumer, services::Lifecycle& lifecycle,
                       std::chrono::milliseconds timeout) {
  const auto deadline = Clock::now() + timeout;
  while (!consumer.has_unwritten()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (lifecycle.stopping() || left.count() <= 0) {
      spdlog::error("no layers came within {:.1f} s: is gvom-fusion running, and has a sweep been mapped?",
                    seconds(timeout));
      return ExitCode::try_again;
    }
    if (!consumer.refresh(std::min(left, kSilenceCheck))) return ExitCode::try_again;
  }
  return consumer.write() ? ExitCode::ok : ExitCode::unavailable;
}

ExitCode consume_until_stop(Consumer& consumer, services::Lifecycle& lifecycle, const Schedule& schedule,
                            const Output& output) {
  auto next = Clock::now();
  bool broker_alive = true;
  while (!lifecycle.stopping() && broker_alive) {
    broker_alive = consumer.refresh(std::min(schedule.every.value_or(kSilenceCheck), kSilenceCheck));
    if (!schedule.every || !consumer.has_unwritten() || Clock::now() < next) continue;
    if (!consumer.write()) return ExitCode::unavailable;
    next = std::max(next + *schedule.every, Clock::now());
  }
  if (broker_alive) broker_alive = consumer.refresh(std::chrono::milliseconds{0});
  if (consumer.has_unwritten() && !consumer.write()) return ExitCode::unavailable;
  if (output.written() == 0) spdlog::error("stopped before any layers came");
  return broker_alive && output.written() > 0 ? ExitCode::ok : ExitCode::try_again;
}

LidarLine line_of(const ipc::LidarStatus& status, std::int64_t stamp_ns) {
  LidarLine line;
  line.name = ipc::text_of(status.name);
  line.maps_in_window = status.maps_in_window;
  line.missing = status.missing != 0;
  line.maps_lost = status.maps_lost;
  line.ground = status.ground;
  if (status.newest_stamp_ns != 0) line.age_s = static_cast<double>(stamp_ns - status.newest_stamp_ns) * 1e-9;
  return line;
}

}  // namespace

LayersPicture picture_of(const ipc::LayersSample& sample, const std::string& vehicle) {
  const ipc::Layers& header = sample.header();
  LayersPicture picture;
  picture.vehicle = vehicle;
  picture.n_xy = header.grid.size[0];
  picture.n_z = header.grid.size[2];
  picture.origin_voxels = header.grid.origin;
  picture.resolution_xy_m = header.grid.resolution_m[0];
  picture.resolution_z_m = header.grid.resolution_m[2];
  std::copy_n(header.T_odom_base.position_m, 3, picture.base_position_m.begin());
  std::copy_n(header.T_odom_base.orientation_xyzw, 4, picture.base_orientation_xyzw.begin());
  picture.stamp_ns = header.header.stamp_ns;
  const auto age = sample.age();
  picture.age_s = age == ipc::kUnknownAge ? std::numeric_limits<double>::infinity() : seconds(age);
  picture.maps_in_window = header.maps_in_window;
  for (std::uint32_t i = 0; i < header.lidar_count; ++i)
    picture.lidars.push_back(line_of(header.lidars[i], picture.stamp_ns));
  for (std::size_t i = 0; i < kLayers; ++i) {
    const auto layer = static_cast<LayerId>(i);
    if (i < kFloatLayers) {
      picture.float_layers[i] = sample.layer_f(layer).data();
    } else {
      picture.byte_layers[i - kFloatLayers] = sample.layer_u8(layer).data();
    }
  }
  return picture;
}

ExitCode consume(ipc::PlannerClient& client, services::Lifecycle& lifecycle, const Schedule& schedule,
                 const std::string& vehicle, Output& output) {
  Consumer consumer(client, vehicle, output);
  lifecycle.on_stop([&client] { client.wake(); });
  const ExitCode code = schedule.once ? consume_first(consumer, lifecycle, schedule.timeout)
                                      : consume_until_stop(consumer, lifecycle, schedule, output);
  lifecycle.on_stop({});
  return code;
}

}  // namespace gvom::snapshot
