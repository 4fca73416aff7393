// What is let through can be read, whoever sent it: fields that no map or layers can have are refused.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "ipc/brick_map.hpp"
#include "ipc/topic.hpp"

using namespace gvom::ipc;

namespace {

constexpr int kSize = 8;
constexpr char kNoPose[] = "it has a pose that is not finite, or over 10,000 km away";
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A chunk that holds one brick with one record; aligned as chunks are.
class OneBrick {
 public:
  OneBrick() : layout_(brick_map_layout(1, 1, 1)), memory_(layout_.bytes / sizeof(Line) + 1) {
    BrickMap& map = header();
    map.header.magic = kMagic;
    map.header.type = static_cast<std::uint16_t>(MessageType::buffer_map);
    map.header.version = BrickMap::kVersion;
    map.header.size = layout_.bytes;
    for (auto& size : map.size_voxels) size = kSize;
    map.base_orientation_xyzw[3] = 1;
    map.brick_slots = map.brick_count = map.record_count = 1;
    record() = {1, 0, 0.5F};
  }
  [[nodiscard]] std::byte* data() { return reinterpret_cast<std::byte*>(memory_.data()); }
  [[nodiscard]] BrickMap& header() { return *reinterpret_cast<BrickMap*>(data()); }
  [[nodiscard]] VoxelRecord& record() { return *reinterpret_cast<VoxelRecord*>(data() + layout_.records); }

  /// Why it is refused; empty if it is not.
  [[nodiscard]] std::string refusal() {
    const auto refusal = check_message(*buffer_map_topic("top"), data(), layout_.bytes);
    return refusal ? refusal->why : "";
  }
  [[nodiscard]] bool deeply_valid() {
    return BrickMapSample(Chunk(nullptr, data())).validate_deep().has_value();
  }

 private:
  struct alignas(kArrayAlignment) Line {
    std::byte bytes[kArrayAlignment];
  };
  BrickMapLayout layout_;
  std::vector<Line> memory_;
};

/// The refusal of a map with one thing wrong.
template <typename Spoil>
std::string refusal_of(const Spoil& spoil) {
  OneBrick map;
  spoil(map.header());
  return map.refusal();
}

}  // namespace

TEST_CASE("a map of one brick is let through and deeply valid") {
  OneBrick map;
  CHECK(map.refusal().empty());
  CHECK(map.deeply_valid());
}

TEST_CASE("stamps whose differences would not fit are refused") {
  constexpr std::int64_t kMost_ns = 4'000'000'000'000'000'000;
  for (const std::int64_t stamp_ns : {kMost_ns, -kMost_ns})
    CHECK(refusal_of([&](BrickMap& map) { map.header.stamp_ns = stamp_ns; }).empty());
  for (const std::int64_t stamp_ns : {kMost_ns + 1, std::numeric_limits<std::int64_t>::min()})
    CHECK(refusal_of([&](BrickMap& map) { map.header.stamp_ns = stamp_ns; }) ==
          "its stamp is " + std::to_string(stamp_ns) + " ns");
}

TEST_CASE("a grid that begins where none can is refused") {
  CHECK(refusal_of([](BrickMap& map) { map.origin_voxels[0] = -(1 << 30); }).empty());
  CHECK(refusal_of([](BrickMap& map) { map.origin_voxels[1] = 4; }) ==
        "it claims to begin at voxel (0, 4, 0)");
  CHECK(refusal_of([](BrickMap& map) { map.origin_voxels[2] = 2147483640; }) ==
        "it claims to begin at voxel (0, 0, 2147483640)");
}

TEST_CASE("a pose that is not finite, or not on Earth, is refused") {
  CHECK(refusal_of([](BrickMap& map) { map.base_position_m[1] = kNan; }) == kNoPose);
  CHECK(refusal_of([](BrickMap& map) { map.base_orientation_xyzw[0] = INFINITY; }) == kNoPose);
  CHECK(refusal_of([](BrickMap& map) { map.base_position_m[2] = 1e300; }) == kNoPose);
}

TEST_CASE("a record without hits, or at no height, is not deeply valid") {
  OneBrick map;
  map.record().min_height_m = INFINITY;
  CHECK(map.refusal().empty());
  CHECK_FALSE(map.deeply_valid());
  map.record().min_height_m = -1e38F;
  CHECK_FALSE(map.deeply_valid());
  map.record() = {0, 0, 0.5F};
  CHECK_FALSE(map.deeply_valid());
}
