// What fusion makes of its window: layers, voxels, and word of how far it is.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ipc/text.hpp"
#include "services/fusion/fusion_node.hpp"
#include "services/fusion/missing.hpp"

namespace gvom::fusion {

namespace {

constexpr std::int64_t kProgressPeriod_ns = 250'000'000;  // also while idle, so that a replay sees us

std::int64_t period_ns(double rate_hz) {
  return static_cast<std::int64_t>(1e9 / rate_hz);
}

}  // namespace

bool FusionNode::layers_due() const {
  return fresh_ && (config_.fusion.rate_hz <= 0 || ipc::monotonic_ns() >= next_tick_ns_);
}

void FusionNode::publish_layers() {
  const std::int64_t begin_ns = ipc::monotonic_ns();
  if (config_.fusion.rate_hz > 0)
    next_tick_ns_ = std::max(next_tick_ns_ + period_ns(config_.fusion.rate_hz), begin_ns);
  fresh_ = false;
  const LayerMoment moment = fuser_.moment();
  auto writer = bus_.layers.loan(moment.grid.size[0], moment.grid.size[2]);
  if (!writer) {
    ++counters_.layers_without_chunk;
    complain("layers are lost: " + writer.error().message);
    return;
  }
  if (const auto made = fuser_.make_layers(writer->arrays()); !made) return fail(made.error());
  record_costs();
  const ipc::BrickMap& last = last_received();
  ipc::Layers& header = writer->header();
  header.grid = moment.grid;
  header.T_odom_base = record_of(moment.T_odom_base);
  fill_lidars(header);
  header.mono_received_ns = last.mono_received_ns;
  header.suspended_ns = last.suspended_ns;
  header.mono_mapped_ns = last.mono_mapped_ns;
  header.mono_map_published_ns = last.mono_published_ns;
  header.mono_fused_ns = fused_ns_;
  const ipc::Moment received = received_at(header);
  bus_.layers.publish(std::move(*writer), moment.stamp_ns, epoch_);
  const ipc::Moment now = ipc::Moment::now();
  lateness_.published(received, now);
  last_layers_ns_ = now.mono_ns;
  counters_.make_layers.record_ns(last_layers_ns_ - begin_ns);
  counters_.received_to_layers.record_ns(last_layers_ns_ - received.mono_ns);
  ++counters_.layers_out;
  health_.count_product();
  services::notify_watchdog();
  voxels_fresh_ = true;
  publish_voxels();
}

const ipc::BrickMap& FusionNode::last_received() const {
  const auto& maps = fuser_.window().maps();
  const auto header = [this](const WindowMap& map) -> const ipc::BrickMap& {
    return bus_.inbox.header(map.token);
  };
  return header(*std::max_element(maps.begin(), maps.end(), [&](const WindowMap& a, const WindowMap& b) {
    return header(a).mono_received_ns < header(b).mono_received_ns;
  }));
}

void FusionNode::record_costs() {
  const auto costs = fuser_.backend().last_costs();
  if (!costs) return;
  if (!device_stages_) device_stages_.emplace(health_);
  device_stages_->record(*costs);
}

void FusionNode::fill_lidars(ipc::Layers& header) const {
  const Window& window = fuser_.window();
  const std::int64_t missing_after_ns = std::llround(config_.fusion.missing_after_s * 1e9);
  header.maps_in_window = static_cast<std::uint32_t>(window.maps().size());
  header.lidar_count = static_cast<std::uint32_t>(bus_.inbox.lidars().size());
  for (std::size_t i = 0; i < bus_.inbox.lidars().size(); ++i) {
    const MapInbox::Lidar& lidar = bus_.inbox.lidars()[i];
    ipc::LidarStatus& status = header.lidars[i];
    ipc::set_text(status.name, lidar.name);
    status.newest_stamp_ns = lidar.newest_stamp_ns;
    status.maps_in_window = static_cast<std::uint32_t>(window.count(static_cast<int>(i)));
    status.missing = is_missing(window, static_cast<int>(i), missing_after_ns) ? 1 : 0;
    status.maps_received = lidar.maps.counters().received;
    status.maps_lost = lidar.maps.counters().lost;
    status.columns_seen_fraction = lidar.columns_seen_fraction;
    status.ground = lidar.ground;
  }
  unknown_.for_each(ipc::monotonic_ns(), [&header](std::string_view name) {
    if (header.lidar_count == kMaxLidars) return;  // Health names it all the same
    ipc::LidarStatus& status = header.lidars[header.lidar_count++];
    ipc::set_text(status.name, name);
    status.missing = status.unknown = 1;
  });
}

void FusionNode::publish_voxels() {
  const std::int64_t now_ns = ipc::monotonic_ns();
  if (config_.fusion.voxel_rate_hz <= 0 || !voxels_fresh_ || now_ns < next_voxels_ns_) return;
  if (!bus_.voxels.has_subscribers()) return;
  voxels_fresh_ = false;
  next_voxels_ns_ = now_ns + period_ns(config_.fusion.voxel_rate_hz);
  const auto shape = fuser_.count_voxels();
  if (!shape) return fail(shape.error());
  auto writer = bus_.voxels.loan(*shape);
  if (!writer) {
    ++counters_.voxels_without_chunk;
    log_drops_(spdlog::level::err, "a voxel map is lost: {}", writer.error().message);
    return;
  }
  const LayerMoment moment = fuser_.moment();
  writer->header().grid = moment.grid;
  writer->header().T_odom_base = record_of(moment.T_odom_base);
  writer->header().columns_seen_fraction = 1;
  writer->header().mono_received_ns = last_received().mono_received_ns;
  writer->header().suspended_ns = last_received().suspended_ns;
  if (const auto written = fuser_.write_voxels(writer->arrays()); !written) return fail(written.error());
  bus_.voxels.publish(std::move(*writer), moment.stamp_ns, epoch_);
  ++counters_.voxel_maps_out;
}

void FusionNode::publish_progress() {
  const std::int64_t now_ns = ipc::monotonic_ns();
  if (!progress_news_ && now_ns < next_progress_ns_) return;
  ipc::Progress progress{};
  ipc::set_text(progress.reader, kOwnName);
  progress.lidar_count = static_cast<std::uint32_t>(bus_.inbox.lidars().size());
  for (std::size_t i = 0; i < bus_.inbox.lidars().size(); ++i) {
    ipc::set_text(progress.taken[i].lidar, bus_.inbox.lidars()[i].name);
    progress.taken[i].sequence = bus_.inbox.lidars()[i].taken_sequence;
  }
  if (!bus_.progress.publish(progress, newest_stamp_ns_, epoch_)) return;
  progress_news_ = false;
  next_progress_ns_ = now_ns + kProgressPeriod_ns;
}

}  // namespace gvom::fusion
