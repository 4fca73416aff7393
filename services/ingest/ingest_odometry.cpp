// What an ingest process takes from the odometry.
#include <spdlog/spdlog.h>

#include "services/ingest/ingest_node.hpp"

namespace gvom::ingest {

void IngestNode::take_odometry() {
  while (const auto progress = bus_.progress.take()) credit_.take(**progress, bus_.maps.sequence());
  while (const auto sample = bus_.odometry.take()) {
    const ipc::Odometry& odometry = **sample;
    const bool end = (odometry.flags & ipc::Odometry::kEndOfStream) != 0;
    if (odometry.header.epoch > odometry_.epoch()) begin_epoch();
    const StampedPose pose{odometry.header.stamp_ns, pose_of(odometry.T_odom_base)};
    const Taken taken = odometry_.take({pose, odometry.header.epoch, end}, ipc::monotonic_ns());
    say(taken, odometry.header.sequence);
    if (taken == Taken::old_epoch) continue;
    odometry_sequence_ = odometry.header.sequence;
    lossless_ = (odometry.flags & ipc::Odometry::kLossless) != 0;
    if (taken == Taken::end) break;
    if (!odometry_.poses().empty()) reader_.set_time_hint(odometry_.poses().newest_ns());
  }
  take_refusals();
}

void IngestNode::take_refusals() {
  odometry_.note_refused(bus_.odometry.counters().refused(), bus_.odometry.port().newest_refusal(),
                         ipc::monotonic_ns());
  while (const auto refusal = bus_.odometry.new_refusal()) spdlog::error("{}", *refusal);
}

void IngestNode::say(Taken taken, std::uint64_t sequence) {
  switch (taken) {
    case Taken::jump:
      return spdlog::warn("odometry {} has jumped: the map begins anew", sequence);
    case Taken::not_a_pose:
      return log_drops_(spdlog::level::warn, "odometry {}: not a pose, not used", sequence);
    case Taken::backwards:
      return log_drops_(spdlog::level::warn, "odometry {}: its time goes back, not used", sequence);
    case Taken::old_epoch:
      return log_drops_(spdlog::level::warn, "odometry {}: of an old epoch, not used", sequence);
    case Taken::used:
    case Taken::gap:
    case Taken::anew:
    case Taken::end:
      return;
  }
}

void IngestNode::begin_epoch() {
  if (odometry_.epoch() == 0) return;  // the first
  ++counters_.epochs;
  spdlog::info("the odometry's clock begins anew");
  if (reader_.is_live()) return;
  release_front();
  reader_.rewind();
}

}  // namespace gvom::ingest
