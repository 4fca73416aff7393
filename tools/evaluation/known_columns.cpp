#include "tools/evaluation/known_columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

namespace gvom::evaluation {
namespace {

using Voxel = KnownColumns::Voxel;

// RELLIS-3D's ontology.
constexpr std::uint32_t kNone = 0, kGrass = 3, kTree = 4, kBush = 19, kConcrete = 23, kPuddle = 31, kMud = 33;

constexpr double kGroundReach_m = 2.0;
constexpr double kLowest_m = 0.5;  // of what makes a column an obstacle
constexpr double kHighest_m = 2.0;
constexpr int kFewestReturns = 2;

bool is_dry_ground(std::uint32_t label) {
  return label == kGrass || label == kMud || label == kConcrete;
}

bool is_ground(std::uint32_t label) {
  return is_dry_ground(label) || label == kPuddle;
}

using Heights = std::map<Voxel, double>;

Heights lowest_ground(const std::vector<LabelledReturn>& returns, const KnownColumns& grid) {
  Heights lowest_m;
  for (const LabelledReturn& r : returns) {
    if (!is_ground(r.label)) continue;
    const auto [at, is_new] = lowest_m.emplace(grid.voxel_of(r.point_m.x(), r.point_m.y()), r.point_m.z());
    if (!is_new) at->second = std::min(at->second, r.point_m.z());
  }
  return lowest_m;
}

/// NaN where no column within reach has ground.
double ground_at(const Heights& lowest_m, const Voxel& voxel, double edge_m) {
  const auto own = lowest_m.find(voxel);
  if (own != lowest_m.end()) return own->second;
  const auto reach = static_cast<std::int64_t>(kGroundReach_m / edge_m);
  double weights = 0.0, sum = 0.0;
  for (std::int64_t dy = -reach; dy <= reach; ++dy)
    for (std::int64_t dx = -reach; dx <= reach; ++dx) {
      const double distance_m = edge_m * std::hypot(dx, dy);
      const auto found = lowest_m.find({voxel[0] + dx, voxel[1] + dy});
      if (found == lowest_m.end() || distance_m > kGroundReach_m) continue;
      weights += 1.0 / (distance_m * distance_m);
      sum += found->second / (distance_m * distance_m);
    }
  return weights > 0.0 ? sum / weights : std::numeric_limits<double>::quiet_NaN();
}

/// Labelled returns of a column.
struct Votes {
  int dry_ground = 0;
  int things = 0;
  int upright = 0;  // labelled, at the height of an obstacle
  int trees = 0, bushes = 0;

  [[nodiscard]] Known verdict() const {
    if (upright >= kFewestReturns && 2 * trees > upright) return Known::tree;
    if (upright >= kFewestReturns && 2 * bushes > upright) return Known::bush;
    return dry_ground > 0 && things == 0 ? Known::drivable : Known::nothing;
  }
};

template <typename T>
tl::expected<std::vector<T>, std::string> read_values(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return tl::unexpected(path + ": cannot be opened");
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  if (bytes.size() % sizeof(T) != 0) return tl::unexpected(path + ": is cut off");
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

}  // namespace

Voxel KnownColumns::voxel_of(double x_m, double y_m) const {
  return {static_cast<std::int64_t>(std::floor(x_m / edge_m_)),
          static_cast<std::int64_t>(std::floor(y_m / edge_m_))};
}

Eigen::Vector2d KnownColumns::middle_of(const Voxel& voxel) const {
  return {(static_cast<double>(voxel[0]) + 0.5) * edge_m_, (static_cast<double>(voxel[1]) + 0.5) * edge_m_};
}

Known KnownColumns::at(const Voxel& voxel) const {
  const auto found = columns_.find(voxel);
  return found == columns_.end() ? Known::nothing : found->second;
}

std::size_t KnownColumns::count(Known known) const {
  return static_cast<std::size_t>(
      std::count_if(columns_.begin(), columns_.end(), [&](const auto& c) { return c.second == known; }));
}

tl::expected<std::vector<LabelledReturn>, std::string> read_labelled(const std::string& scan,
                                                                     const std::string& labels) {
  const auto points = read_values<float>(scan);
  if (!points) return tl::unexpected(points.error());
  const auto classes = read_values<std::uint32_t>(labels);
  if (!classes) return tl::unexpected(classes.error());
  if (points->size() != 4 * classes->size())
    return tl::unexpected(labels + ": has " + std::to_string(classes->size()) + " labels for " +
                          std::to_string(points->size() / 4) + " points");
  std::vector<LabelledReturn> returns;
  for (std::size_t i = 0; i < classes->size(); ++i) {
    const float* at = points->data() + 4 * i;
    if (at[0] == 0.0F && at[1] == 0.0F && at[2] == 0.0F) continue;
    returns.push_back({{at[0], at[1], at[2]}, (*classes)[i]});
  }
  return returns;
}

KnownColumns know_by_labels(const std::vector<LabelledReturn>& returns, double edge_m) {
  KnownColumns known(edge_m);
  const Heights lowest_m = lowest_ground(returns, known);
  std::map<Voxel, Votes> columns;
  for (const LabelledReturn& r : returns) {
    if (r.label == kNone) continue;
    const Voxel voxel = known.voxel_of(r.point_m.x(), r.point_m.y());
    Votes& votes = columns[voxel];
    votes.dry_ground += is_dry_ground(r.label);
    votes.things += !is_ground(r.label);
    const double above_m = r.point_m.z() - ground_at(lowest_m, voxel, edge_m);
    if (!(above_m >= kLowest_m && above_m <= kHighest_m)) continue;
    ++votes.upright;
    votes.trees += r.label == kTree;
    votes.bushes += r.label == kBush;
  }
  for (const auto& [voxel, votes] : columns)
    if (votes.verdict() != Known::nothing) known.set(voxel, votes.verdict());
  return known;
}

}  // namespace gvom::evaluation
