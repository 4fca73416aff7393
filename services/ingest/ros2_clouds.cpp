#include "services/ingest/ros2_clouds.hpp"

#include <utility>

#include "ipc/clock.hpp"
#include "services/ingest/arrival_clock.hpp"
#include "services/ingest/ros2_publisher.hpp"

namespace gvom::ingest {
namespace {

constexpr double kMostCloudsPerS = 100;  // of a lidar without turns, or in pieces of a turn

}  // namespace

Ros2Clouds::Ros2Clouds(dds::Reader reader, const std::string& name, const CloudOptions& options,
                       std::int64_t clock_offset_ns)
    : reader_(std::move(reader)),
      name_(name),
      sweeps_(options, name, "ros2"),
      clock_offset_ns_(clock_offset_ns) {}

double Ros2Clouds::most_packets_per_s() const {
  return kMostCloudsPerS;
}

tl::expected<SourceEvent, std::string> Ros2Clouds::next(Sweep& out, std::chrono::milliseconds timeout) {
  out.clear();
  const auto message = reader_.take(timeout);
  const dds::ReaderCounters reader = reader_.counters();
  state_.counters.kernel_drops = reader.lost + reader.replaced;
  if (const std::string loss = message ? "" : reader_.network_loss(); !loss.empty())
    return tl::unexpected(name_ + ": " + loss);
  if (!message) return SourceEvent::kIdle;
  ++state_.counters.packets;
  if (!owner_.is_owner(message->publisher, message->arrived_ns)) {
    ++state_.counters.second_sensor_packets;
    state_.counters.second_address = address_of_publisher(message->publisher);
    return SourceEvent::kIdle;
  }
  return make(*message, out) ? SourceEvent::kSweep : SourceEvent::kIdle;
}

bool Ros2Clouds::make(const dds::Message& message, Sweep& out) {
  auto made = ros::read_point_cloud({message.cdr->data(), message.cdr->size()}, cloud_);
  if (made) made = sweeps_.make(cloud_, state_, out);
  if (!made) {
    unused_.add(state_, name_, made.error(), message.cdr->size());
    out.clear();
    return false;
  }
  shift(out, clock_offset_ns_);
  out.received_ns = message.arrived_ns;
  out.suspended_ns = ipc::suspended_ns();
  ++state_.counters.sweeps;
  return true;
}

tl::expected<void, std::string> Ros2Clouds::rewind() {
  return tl::unexpected(name_ + ": a live source cannot start again");
}

}  // namespace gvom::ingest
