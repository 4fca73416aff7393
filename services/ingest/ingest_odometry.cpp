// What an ingest process takes from the odometry.
#include <spdlog/spdlog.h>

#include "services/common/bus/core_types.hpp"
#include "services/ingest/ingest_node.hpp"

namespace gvom::ingest {

void IngestNode::take_odometry() {
  while (const auto progress = bus_.progress.take()) credit_.take(**progress, bus_.maps.sequence());
  while (const auto sample = bus_.odometry.take()) {
    const ipc::Odometry& odometry = **sample;
    if (odometry.header.epoch > epoch_) begin_epoch(odometry.header.epoch);
    if (odometry.header.epoch < epoch_) continue;  // of a clock that has been replaced
    odometry_sequence_ = odometry.header.sequence;
    lossless_ = (odometry.flags & ipc::Odometry::kLossless) != 0;
    end_of_stream_ = (odometry.flags & ipc::Odometry::kEndOfStream) != 0;
    odometry_came_ns_ = ipc::monotonic_ns();
    ++counters_.poses;
    if (end_of_stream_) break;  // its pose is the last one again
    take_pose({odometry.header.stamp_ns, services::pose_of(odometry.position_m, odometry.orientation_xyzw)});
  }
}

void IngestNode::take_pose(const StampedPose& pose) {
  if (reader_.is_live()) {
    const OdometryStep step = odometry_watch_.step(pose, odometry_came_ns_);
    if (step != OdometryStep::steady) break_odometry(step, pose);
  }
  const OdometryBuffer::Add result = odometry_.add(pose);
  odometry_watch_.note(result, odometry_came_ns_);
  switch (result) {
    case OdometryBuffer::Add::added:
      reader_.set_time_hint(pose.stamp_ns);
      break;
    case OdometryBuffer::Add::not_finite:
      ++counters_.not_finite_poses;
      log_drops_(spdlog::level::warn, "odometry {}: not a pose, not used", odometry_sequence_);
      break;
    case OdometryBuffer::Add::not_newer:
      ++counters_.not_newer_poses;
      log_drops_(spdlog::level::warn, "odometry {}: its time goes back, not used", odometry_sequence_);
      break;
  }
}

void IngestNode::break_odometry(OdometryStep step, const StampedPose& pose) {
  map_due_sweeps();  // those before are not concerned
  odometry_.clear();
  odometry_broken_ = true;
  if (step != OdometryStep::jump) {
    ++counters_.odometry_gaps;
    return;
  }
  ++counters_.odometry_jumps;
  odometry_jump_ns_ = pose.stamp_ns;
  spdlog::warn("odometry {} has jumped: the map begins anew", odometry_sequence_);
}

void IngestNode::begin_epoch(std::uint64_t epoch) {
  const bool first = epoch_ == 0;
  epoch_ = epoch;
  odometry_.clear();
  odometry_watch_.begin_anew();
  odometry_broken_ = false;
  odometry_jump_ns_ = 0;
  end_of_stream_ = false;
  front_since_ns_ = 0;
  if (first) return;
  ++counters_.epochs;
  spdlog::info("the odometry's clock begins anew");
  if (!reader_.is_live()) reader_.rewind();
}

}  // namespace gvom::ingest
