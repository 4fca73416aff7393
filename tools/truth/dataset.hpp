// What gvom-truth reads: the simulator's truth and the maps that gvom-map wrote.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace gvom::truth {

/// The numbers in `class.npy`.
enum Class : std::uint8_t { kGround, kTree, kBush, kRock, kDitch, kStepFace, kOverhang, kPerson };

/// The bits in `flags.npy` (R9, R11..R13).
enum Flag : std::uint8_t { kHard = 1, kSoft = 2, kNegative = 4, kSteep = 8, kAssumed = 16 };

struct Object {
  std::string kind;
  double height_m;
};

struct TrackPoint {
  double time_s;
  double x_m;
  double y_m;
};

/// Layers are indexed [y][x]; their meaning stands in tools/sim/ground_truth.hpp.
struct Truth {
  double resolution_m = 0.0;
  std::array<std::int64_t, 2> origin{};  ///< World voxel (R1) of column (0, 0).
  int size_x = 0;
  int size_y = 0;
  std::vector<float> ground_lowest, ground_mean, drop_m, clearance;
  std::vector<std::uint8_t> classes;
  std::vector<std::int32_t> object;
  std::vector<Object> objects;
  std::vector<TrackPoint> person;
};

/// Where and when a map is: its `meta.json`.
struct FrameInfo {
  std::string directory;
  std::int64_t stamp_ns = 0;
  std::array<std::int64_t, 2> origin{};  ///< World voxel of column (0, 0).
  int size = 0;                          ///< Columns along an edge.
  double resolution_m = 0.0;
  std::array<double, 2> base_m{};  ///< base_link in odom.
};

/// The layers of one map that are judged, indexed [y][x].
struct Frame {
  FrameInfo info;
  std::vector<float> height, clearance;
  std::vector<std::uint8_t> flags, visibility;
};

/// Errors name the file and the reason.
tl::expected<Truth, std::string> read_truth(const std::string& directory);
/// All `DIR/NNNNNN`, in order; an error if there is none.
tl::expected<std::vector<FrameInfo>, std::string> list_frames(const std::string& directory);
tl::expected<Frame, std::string> read_frame(const FrameInfo& info);

}  // namespace gvom::truth
