// Messages from the bus. First byte: the topic; the rest is the chunk. What is let through is read as its
// readers do: all arrays, and of a map that is deeply valid the fused map and its layers.
#include <cmath>
#include <memory>
#include <vector>

#include "core/mapper.hpp"
#include "ipc/brick_map.hpp"
#include "ipc/layers.hpp"
#include "ipc/text.hpp"
#include "ipc/topic.hpp"
#include "services/ingest/fusion_credit.hpp"
#include "tests/fuzz/input.hpp"

using namespace gvom;
using namespace gvom::fuzz;

namespace {

constexpr int kSize = 8;  // of the grid that maps are fused in, voxels

/// The message in memory of its own, aligned as chunks are: reading past its end is seen.
using ChunkMemory = std::unique_ptr<std::byte, decltype(&std::free)>;

ChunkMemory chunk_of(ingest::Bytes bytes) {
  void* memory = nullptr;
  require(::posix_memalign(&memory, kArrayAlignment, std::max<std::size_t>(bytes.size, 1)) == 0,
          "there is memory");
  if (bytes.size > 0) std::memcpy(memory, bytes.data, bytes.size);
  return {static_cast<std::byte*>(memory), &std::free};
}

template <typename T>
double sum_of(ipc::Span<const T> values) {
  double sum = 0;
  for (const T& value : values) sum += static_cast<double>(value);
  return sum;
}

/// Layers in memory of their own.
class LayerMemory {
 public:
  LayerArrays arrays() {
    const auto f = [this](std::size_t i) { return floats_.data() + i * kCells; };
    const auto u8 = [this](std::size_t i) { return bytes_.data() + i * kCells; };
    return {f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7), f(8), f(9), u8(0), u8(1), u8(2)};
  }

 private:
  static constexpr std::size_t kCells = kSize * kSize;
  std::vector<float> floats_ = std::vector<float>(10 * kCells);
  std::vector<std::uint8_t> bytes_ = std::vector<std::uint8_t>(3 * kCells);
};

void fuse(const ipc::BrickMapSample& map) {
  MapperConfig config;
  config.map.size_xy = config.map.size_z = kSize;
  config.window.buffer_size = 1;
  MapFuser fuser(config);
  const auto added = fuser.add({map.view(), 0, 0});
  if (!added || *added != AddResult::added) return;
  require(fuser.make_layers(LayerMemory().arrays()).has_value(), "the CPU makes layers of any map");
  require(fuser.count_voxels()->record_count <= kSize * kSize * kSize, "a grid has so many voxels");
  fuser.reset();
}

double read_map(const std::byte* message) {
  const ipc::BrickMapSample map(ipc::Chunk(nullptr, message));
  double sum =
      sum_of(map.directory()) + sum_of(map.lookup()) + sum_of(map.columns()) + sum_of(map.lowest_ray_m());
  for (const VoxelRecord& record : map.records()) sum += record.hits + record.passes;
  if (map.validate_deep()) fuse(map);
  return sum;
}

double read_layers(const std::byte* message) {
  const ipc::LayersSample layers(ipc::Chunk(nullptr, message));
  double sum = static_cast<double>(layers.missing_lidars().size());
  for (int i = 0; i < kLayers; ++i) {
    const auto id = static_cast<LayerId>(i);
    sum += sum_of(layers.layer_u8(id));
    for (const float value : layers.layer_f(id)) sum += std::isnan(value) ? 0 : 1;
  }
  const auto& base = layers.header().T_odom_base.position_m;
  if (const auto index = layers.index_of(base[0], base[1])) sum += layers.layer_u8(LayerId::cost)[*index];
  (void)layers.age();
  return sum;
}

double read_odometry(const std::byte* message) {
  const auto& odometry = *reinterpret_cast<const ipc::Odometry*>(message);
  OdometryBuffer buffer(4);
  const std::int64_t stamp_ns = odometry.header.stamp_ns;
  buffer.add({stamp_ns - 100, Pose{}});
  buffer.add({stamp_ns, pose_of(odometry.T_odom_base)});
  const auto pose = buffer.at(stamp_ns - 50);
  return pose ? pose->translation_m.norm() : 0;
}

double read_progress(const std::byte* message) {
  const auto& progress = *reinterpret_cast<const ipc::Progress*>(message);
  ingest::FusionCredit credit("front");
  credit.take(progress, 7);
  return credit.has_room(9) ? 1 : 0;
}

double read_health(const std::byte* message) {
  const auto& health = *reinterpret_cast<const ipc::Health*>(message);
  std::size_t length = ipc::text_of(health.process).size() + ipc::text_of(health.reason).size();
  for (std::uint32_t i = 0; i < health.counter_count; ++i)
    length += ipc::text_of(health.counters[i].name).size();
  for (std::uint32_t i = 0; i < health.stage_count; ++i) length += ipc::text_of(health.stages[i].name).size();
  return static_cast<double>(length);
}

struct Reader {
  ipc::Topic topic;
  double (*read)(const std::byte* message);
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Reader kReaders[] = {
      {ipc::topic_of<ipc::Odometry>(), read_odometry}, {ipc::topic_of<ipc::Progress>(), read_progress},
      {ipc::topic_of<ipc::Health>(), read_health},     {ipc::layers_topic(), read_layers},
      {*ipc::buffer_map_topic("front"), read_map},     {ipc::voxel_map_topic(), read_map}};
  Input input(data, size);
  const Reader& reader = kReaders[input.byte() % std::size(kReaders)];
  const ingest::Bytes bytes = input.rest();
  const ChunkMemory chunk = chunk_of(bytes);
  const auto refusal = ipc::check_message(reader.topic, chunk.get(), bytes.size);
  require(!refusal || !refusal->why.empty(), "a refusal says why");
  if (refusal) return 0;
  volatile double sink = reader.read(chunk.get());
  (void)sink;
  return 0;
}
