#include "tools/map/offline.hpp"

#include <algorithm>
#include <utility>

#include "services/common/tum.hpp"

namespace gvom::tools {

namespace {

// Far enough apart for every stamp, near enough for their difference to be an int64.
constexpr std::int64_t kLongAgo_ns = -4'000'000'000'000'000'000;

}  // namespace

tl::expected<OfflineMapper, std::string> OfflineMapper::open(const services::VehicleConfig& config,
                                                             const std::string& odometry, bool deskew) {
  OfflineMapper mapper;
  mapper.deskew_ = deskew;
  mapper.fuser_ = std::make_unique<MapFuser>(config.mapper);
  if (auto added = mapper.add_odometry(odometry); !added) return tl::unexpected(added.error());
  for (const services::LidarConfig& lidar : config.lidars) {
    if (lidar.source.empty()) continue;
    if (auto added = mapper.add_lidar(config, lidar); !added) return tl::unexpected(added.error());
  }
  if (mapper.lidars_.empty())
    return tl::unexpected(std::string("no lidar has a source: give --source NAME=URI"));
  return mapper;
}

tl::expected<void, std::string> OfflineMapper::add_odometry(const std::string& odometry) {
  std::vector<StampedPose> poses{{kLongAgo_ns, {}}, {-kLongAgo_ns, {}}};
  if (odometry != "static") {
    auto recorded = services::read_odometry_source(odometry);
    if (!recorded) return tl::unexpected(recorded.error());
    poses = std::move(*recorded);
  }
  odometry_ = std::make_unique<OdometryBuffer>(poses.size());
  for (const StampedPose& pose : poses)
    if (odometry_->add(pose) != OdometryBuffer::Add::added)
      return tl::unexpected(odometry + ": a pose is too far away to be mapped");
  return {};
}

tl::expected<void, std::string> OfflineMapper::add_lidar(const services::VehicleConfig& config,
                                                         const services::LidarConfig& lidar) {
  const auto max_returns = static_cast<std::size_t>(lidar.max_returns);
  auto source = ingest::open_source(lidar.source, {lidar.min_sweep_fraction, max_returns});
  if (!source) return tl::unexpected("lidar " + lidar.name + ": " + source.error());
  if ((*source)->is_live()) return tl::unexpected("lidar " + lidar.name + ": " + lidar.source + " is live");
  Lidar added;
  added.name = lidar.name;
  added.source = std::move(*source);
  added.mapper = std::make_unique<SweepMapper>(config.mapper, lidar.geometry, max_returns);
  lidars_.push_back(std::move(added));
  if (auto first = advance(lidars_.back()); !first) return tl::unexpected(first.error());
  return {};
}

tl::expected<void, std::string> OfflineMapper::advance(Lidar& lidar) {
  const auto event = lidar.source->next(lidar.sweep, std::chrono::milliseconds(0));
  lidar.ended = !event || *event == ingest::SourceEvent::kEnd;
  if (!event) return tl::unexpected("lidar " + lidar.name + ": " + event.error());
  if (!deskew_) std::fill(lidar.sweep.times_ns.begin(), lidar.sweep.times_ns.end(), lidar.sweep.stamp_ns);
  return {};
}

bool OfflineMapper::map_sweep(std::size_t index, MappedSweep& mapped) {
  Lidar& lidar = lidars_[index];
  const auto shape = lidar.mapper->count(lidar.sweep, *odometry_);
  if (!shape) return ++without_odometry_, false;
  auto map = std::make_unique<BrickMapStorage>();
  lidar.mapper->write(map->resize(*shape));
  const std::uint64_t token = next_token_++;
  const BrickMapView view =
      map->view(lidar.mapper->grid(), lidar.sweep.stamp_ns, lidar.mapper->T_odom_base());
  if (fuser_->add({view, static_cast<int>(index), token}) != AddResult::added) return ++refused_, false;
  window_.emplace(token, std::move(map));
  for (const WindowMap& left : fuser_->window().left()) window_.erase(left.token);
  mapped = {lidar.name, lidar.sweep.stamp_ns, lidar.sweep.complete, lidar.mapper->filter_counts()};
  return true;
}

tl::expected<bool, std::string> OfflineMapper::next(MappedSweep& mapped) {
  for (;;) {
    if (!error_.empty()) return tl::unexpected(std::exchange(error_, {}));
    std::size_t first = lidars_.size();
    for (std::size_t i = 0; i < lidars_.size(); ++i) {
      if (lidars_[i].ended) continue;
      if (first == lidars_.size() || lidars_[i].sweep.stamp_ns < lidars_[first].sweep.stamp_ns) first = i;
    }
    if (first == lidars_.size()) return false;
    const bool fused = map_sweep(first, mapped);
    if (auto advanced = advance(lidars_[first]); !advanced) error_ = advanced.error();
    if (fused) return true;
  }
}

}  // namespace gvom::tools
