// What is known of some columns of a real place: its truth is not complete.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace gvom::evaluation {

enum class Known : std::uint8_t { nothing, drivable, tree, bush };

/// By the columns' world voxels (R1).
class KnownColumns {
 public:
  using Voxel = std::array<std::int64_t, 2>;
  /// @param edge_m of a column
  explicit KnownColumns(double edge_m) : edge_m_(edge_m) {}

  [[nodiscard]] double edge_m() const { return edge_m_; }
  [[nodiscard]] Voxel voxel_of(double x_m, double y_m) const;
  [[nodiscard]] Eigen::Vector2d middle_of(const Voxel& voxel) const;
  [[nodiscard]] Known at(const Voxel& voxel) const;
  void set(const Voxel& voxel, Known known) { columns_[voxel] = known; }
  [[nodiscard]] std::size_t count(Known known) const;

 private:
  double edge_m_;
  std::map<Voxel, Known> columns_;
};

/// A return with its class in RELLIS-3D's ontology (0: none).
struct LabelledReturn {
  Eigen::Vector3d point_m;
  std::uint32_t label;
};

/// A scan of an OS1, in its frame, as RELLIS-3D has it: float32 x y z intensity, and uint32 labels. Returns
/// at the origin are none. Errors name the file.
tl::expected<std::vector<LabelledReturn>, std::string> read_labelled(const std::string& scan,
                                                                     const std::string& labels);

/// A column's ground is its lowest return of grass, mud, concrete or puddle; without one, the mean of those
/// of the columns within 2 m, weighted by 1 / distance^2. A column is a tree (a bush) if of its labelled
/// returns between 0.5 and 2 m above that, at least two, more than half are. It is drivable if it has returns
/// of grass, mud or concrete and, at any height, none of a thing.
KnownColumns know_by_labels(const std::vector<LabelledReturn>& returns, double edge_m);

}  // namespace gvom::evaluation
