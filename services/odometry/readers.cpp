#include "services/odometry/readers.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "ipc/text.hpp"

namespace gvom::odometry {

namespace {

bool same_progress(const ipc::Progress& a, const ipc::Progress& b) {
  const auto same_taken = [](const ipc::Progress::Taken& x, const ipc::Progress::Taken& y) {
    return x.sequence == y.sequence;
  };
  return a.odometry_sequence == b.odometry_sequence && a.maps_published == b.maps_published &&
         std::equal(std::begin(a.taken), std::end(a.taken), std::begin(b.taken), same_taken);
}

/// A new ingest's maps all come to the fusion that is there.
void forget_maps(Reader& ingest) {
  ingest.missed_maps = 0;
  ingest.will_tell_missed = false;
}

}  // namespace

Readers::Readers(const std::vector<std::string>& lidars, std::uint64_t first_epoch)
    : first_epoch_(first_epoch) {
  for (const std::string& lidar : lidars) ingests_.emplace_back().name = lidar;
  fusion_.name = "fusion";
}

const Reader* Readers::take(const ipc::Progress& progress, std::uint64_t published, std::int64_t mono_ns) {
  const std::string_view name = ipc::text_of(progress.reader);
  const auto ingest = std::find_if(ingests_.begin(), ingests_.end(),
                                   [&](const Reader& reader) { return reader.name == name; });
  if (ingest == ingests_.end() && name != fusion_.name) return nullptr;
  Reader& reader = ingest != ingests_.end() ? *ingest : fusion_;

  const bool restarted = reader.announced && progress.header.sequence <= reader.latest.header.sequence;
  if (restarted) {
    ++reader.restarts;
    reader.acknowledged = published;
    if (&reader == &fusion_)
      for (Reader& lidar : ingests_) lidar.will_tell_missed = lidar.announced;
    else
      forget_maps(reader);
  }
  if (std::exchange(reader.will_tell_missed, false)) reader.missed_maps = progress.maps_published;
  if (progress.header.epoch >= first_epoch_) {
    reader.acknowledged = std::max(reader.acknowledged, std::min(progress.odometry_sequence, published));
  }
  if (!reader.announced || restarted || !same_progress(progress, reader.latest)) reader.advanced_ns = mono_ns;
  reader.announced = true;
  reader.heard_ns = mono_ns;
  reader.latest = progress;
  return restarted ? &reader : nullptr;
}

std::vector<std::string> Readers::missing() const {
  std::vector<std::string> names;
  for (const Reader& reader : ingests_) {
    if (!reader.announced) names.push_back(reader.name);
  }
  if (!fusion_.announced) names.push_back(fusion_.name);
  return names;
}

const Reader* Readers::slowest() const {
  const Reader* slowest = nullptr;
  for (const Reader& reader : ingests_) {
    if (reader.announced && (slowest == nullptr || reader.acknowledged < slowest->acknowledged))
      slowest = &reader;
  }
  return slowest;
}

std::uint64_t Readers::taken_by_fusion(const std::string& lidar) const {
  const std::size_t count = std::min<std::size_t>(fusion_.latest.lidar_count, kMaxLidars);
  for (std::size_t i = 0; i < count; ++i) {
    const ipc::Progress::Taken& taken = fusion_.latest.taken[i];
    if (ipc::text_of(taken.lidar) == lidar) return taken.sequence;
  }
  return 0;
}

std::vector<std::string> Readers::outstanding(std::uint64_t sequence, std::int64_t heard_since_ns) const {
  std::vector<std::string> lines;
  for (const Reader& reader : ingests_) {
    if (!reader.announced || reader.heard_ns < heard_since_ns) continue;
    if (reader.acknowledged < sequence) {
      lines.push_back("'" + reader.name + "' is at odometry " + std::to_string(reader.acknowledged) + " of " +
                      std::to_string(sequence));
    }
    if (!fusion_.announced || fusion_.heard_ns < heard_since_ns) continue;
    const std::uint64_t taken_now = taken_by_fusion(reader.name);  // in their order: 0 if it began anew
    const std::uint64_t taken = taken_now > 0 ? taken_now : reader.missed_maps;
    if (taken_now == 0 && reader.will_tell_missed) {
      lines.push_back("'" + reader.name + "' has yet to say which maps it made before fusion began anew");
    } else if (taken < reader.latest.maps_published) {
      lines.push_back("fusion took " + std::to_string(taken) + " of " +
                      std::to_string(reader.latest.maps_published) + " maps of '" + reader.name + "'");
    }
  }
  return lines;
}

std::int64_t Readers::last_advance_ns() const {
  std::int64_t newest = fusion_.advanced_ns;
  for (const Reader& reader : ingests_) newest = std::max(newest, reader.advanced_ns);
  return newest;
}

std::uint64_t Readers::maps_published() const {
  std::uint64_t sum = 0;
  for (const Reader& reader : ingests_) sum += reader.latest.maps_published;
  return sum;
}

}  // namespace gvom::odometry
