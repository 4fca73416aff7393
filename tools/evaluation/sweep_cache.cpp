#include "tools/evaluation/sweep_cache.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "tools/sim/noise.hpp"

namespace gvom::evaluation {
namespace {

constexpr int kProbedColumns = 32;  // of the first and of the last sweep

/// Mixes what it is given into one number.
class Hash {
 public:
  void add(std::uint64_t value) { value_ = sim::derive(value_, value); }
  void add(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    add(bits);
  }
  void add(const Eigen::Vector3d& value) {
    for (const double part : {value.x(), value.y(), value.z()}) add(part);
  }
  void add_bytes(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (; size >= 8; bytes += 8, size -= 8) {
      std::uint64_t word;
      std::memcpy(&word, bytes, sizeof word);
      add(word);
    }
    for (; size > 0; ++bytes, --size) add(std::uint64_t{*bytes});
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0x67766F6D;
};

void add_object(Hash& hash, const sim::Object& object) {
  hash.add(static_cast<std::uint64_t>(object.kind));
  for (const sim::Body& body : object.bodies) {
    hash.add(static_cast<std::uint64_t>(body.shape));
    hash.add(body.centre);
    hash.add(body.size);
    for (const double value : {body.radius_m, body.yaw_rad, body.hits_per_m}) hash.add(value);
    hash.add(std::uint64_t{body.reflectivity});
  }
  for (const sim::TrackPoint& point : object.track)
    for (const double value : {point.time_s, point.x_m, point.y_m}) hash.add(value);
}

/// Of the lidar, the drive and what is measured: where it looks from, and what it sees in some columns.
std::uint64_t probe(const sim::SweepSimulator& simulator, const SweepSpan& span) {
  const sim::LidarModel& lidar = simulator.lidar();
  std::vector<sim::Pixel> pixels(static_cast<std::size_t>(lidar.beams()));
  Hash hash;
  for (const int sweep : {span.first, span.first + span.count - 1})
    for (int i = 0; i < kProbedColumns; ++i) {
      const int column = i * lidar.columns / kProbedColumns;
      simulator.measure_column(sweep, column, pixels.data());
      for (const sim::Pixel& pixel : pixels) hash.add(std::uint64_t{pixel.range_units});
    }
  return hash.value();
}

std::string file_name(std::uint64_t key) {
  char name[32];
  std::snprintf(name, sizeof name, "%016llx.sweeps", static_cast<unsigned long long>(key));
  return name;
}

}  // namespace

std::uint64_t key_of(const sim::WorldData& world) {
  Hash hash;
  const sim::GroundMap& ground = world.ground;
  for (const double value : {ground.resolution_m, ground.min_x_m, ground.min_y_m, world.rain_hits_per_m})
    hash.add(value);
  hash.add(static_cast<std::uint64_t>(ground.nodes_x));
  hash.add_bytes(ground.height_m.data(), ground.height_m.size() * sizeof(float));
  hash.add_bytes(ground.surface.data(), ground.surface.size());
  for (const sim::Object& object : world.objects) add_object(hash, object);
  for (const Eigen::Vector2d& point : world.path_m)
    for (const double value : {point.x(), point.y()}) hash.add(value);
  return hash.value();
}

SweepCache::SweepCache(const sim::SweepSimulator& simulator, const SweepSpan& span)
    : simulator_(&simulator),
      span_(span),
      range_units_(static_cast<std::size_t>(simulator.lidar().columns) * simulator.lidar().beams()) {}

tl::expected<SweepCache, std::string> SweepCache::open(const sim::SweepSimulator& simulator,
                                                       const SweepSpan& span, std::uint64_t world_key,
                                                       const std::string& directory) {
  SweepCache cache(simulator, span);
  if (directory.empty()) return cache;
  Hash hash;
  hash.add(world_key);
  hash.add(static_cast<std::uint64_t>(span.first));
  hash.add(static_cast<std::uint64_t>(span.count));
  hash.add(probe(simulator, span));
  cache.path_ = directory + "/" + file_name(hash.value());
  cache.reads_.reset(std::fopen(cache.path_.c_str(), "rb"));
  if (cache.reads_) return cache;
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) return tl::unexpected(directory + ": " + error.message());
  cache.writes_.reset(std::fopen((cache.path_ + ".part").c_str(), "wb"));
  if (!cache.writes_) return tl::unexpected(cache.path_ + ".part: " + std::strerror(errno));
  return cache;
}

tl::expected<void, std::string> SweepCache::next(Sweep& out) {
  const int sweep = span_.first + done_++;
  if (reads_) {
    if (std::fread(range_units_.data(), sizeof(std::uint16_t), range_units_.size(), reads_.get()) !=
        range_units_.size())
      return tl::unexpected(path_ + ": is shorter than it was written; delete it");
  } else {
    range_units_ = simulator_->measure_ranges(sweep);
  }
  if (writes_) {
    if (std::fwrite(range_units_.data(), sizeof(std::uint16_t), range_units_.size(), writes_.get()) !=
        range_units_.size())
      return tl::unexpected(path_ + ".part: " + std::strerror(errno));
    if (done_ == span_.count) {
      if (std::fclose(writes_.release()) != 0 || std::rename((path_ + ".part").c_str(), path_.c_str()) != 0)
        return tl::unexpected(path_ + ": " + std::strerror(errno));
    }
  }
  simulator_->assemble(sweep, range_units_, out);
  return {};
}

}  // namespace gvom::evaluation
