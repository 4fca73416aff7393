#include "services/common/odometry_lines.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/LU>

#include "services/common/stamps.hpp"

namespace gvom::services {

namespace {

using Words = std::vector<std::string_view>;

constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kKittiColumns = 12;
constexpr double kRotationTolerance = 1e-3;
constexpr std::string_view kBlanks = " \t\r\f\v";

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  text.remove_suffix(text.size() - (text.find_last_not_of(kBlanks) + 1));
  return text;
}

/// What stands between the separators; blanks in a row are one.
Words split(std::string_view line, char separator) {
  Words words;
  for (line = trimmed(line); !line.empty();) {
    const std::size_t end = separator == ' ' ? line.find_first_of(kBlanks) : line.find(separator);
    words.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) break;
    line.remove_prefix(end + 1);
    if (separator == ' ')
      line = trimmed(line);
    else if (line.empty())
      words.emplace_back();
  }
  return words;
}

tl::unexpected<std::string> unexpected(const std::string& reason) {
  return tl::make_unexpected(reason);
}

tl::expected<std::vector<double>, std::string> parse_numbers(const Words& words, std::size_t first,
                                                             std::size_t end) {
  std::vector<double> values;
  for (std::size_t i = first; i < end; ++i) {
    const std::string_view word = words[i];
    const char* const begin = word.data() + (!word.empty() && word[0] == '+' ? 1 : 0);
    const char* const last = word.data() + word.size();
    double value = 0;
    const auto parsed = std::from_chars(begin, last, value);
    if (parsed.ec != std::errc{} || parsed.ptr != last || !std::isfinite(value))
      return unexpected("expected a finite number, found '" + std::string(word) + "'");
    values.push_back(value);
  }
  return values;
}

std::optional<std::int64_t> parse_whole(std::string_view word) {
  std::int64_t value = 0;
  const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
  if (parsed.ec != std::errc{} || parsed.ptr != word.data() + word.size()) return std::nullopt;
  return value;
}

constexpr std::size_t kNanosecondsSince1970Digits = 18;  // as many at least, and no point

bool has_nanoseconds(std::string_view word) {
  return word.size() >= kNanosecondsSince1970Digits && parse_whole(word).has_value();
}

}  // namespace

PoseResult make_pose(std::int64_t stamp_ns, const Eigen::Vector3d& position_m,
                     const Eigen::Quaterniond& rotation) {
  if (!position_m.allFinite()) return unexpected("expected a finite position");
  const double norm = rotation.norm();
  if (!(std::abs(norm - 1.0) <= kRotationTolerance))
    return unexpected("expected a unit quaternion, found one of norm " + std::to_string(norm));
  return StampedPose{stamp_ns, {position_m, rotation.normalized()}};
}

PoseResult parse_tum_line(const std::string& line) {
  const Words words = split(line, ' ');
  if (words.size() != kTumColumns) {
    return unexpected("expected 8 columns (t x y z qx qy qz qw), found " + std::to_string(words.size()));
  }
  const auto stamp_ns = parse_stamp_ns(words[0]);
  if (!stamp_ns) return unexpected("expected a time in seconds, found '" + std::string(words[0]) + "'");
  const auto v = parse_numbers(words, 1, kTumColumns);
  if (!v) return unexpected(v.error());
  return make_pose(*stamp_ns, {(*v)[0], (*v)[1], (*v)[2]},
                   Eigen::Quaterniond((*v)[6], (*v)[3], (*v)[4], (*v)[5]));
}

PoseResult parse_euroc_line(const std::string& line) {
  const Words words = split(line, ',');
  if (words.size() < kTumColumns) {
    return unexpected("expected at least 8 columns (t,x,y,z,qw,qx,qy,qz), found " +
                      std::to_string(words.size()));
  }
  const auto stamp_ns = parse_whole(words[0]);
  if (!stamp_ns)
    return unexpected("expected a time in whole nanoseconds, found '" + std::string(words[0]) + "'");
  const auto v = parse_numbers(words, 1, kTumColumns);
  if (!v) return unexpected(v.error());
  return make_pose(*stamp_ns, {(*v)[0], (*v)[1], (*v)[2]},
                   Eigen::Quaterniond((*v)[3], (*v)[4], (*v)[5], (*v)[6]));
}

PoseResult parse_kitti_line(const std::string& line) {
  const Words words = split(line, ' ');
  if (words.size() != kKittiColumns) {
    return unexpected("expected 12 columns (the rows of a 3x4 matrix), found " +
                      std::to_string(words.size()));
  }
  const auto v = parse_numbers(words, 0, kKittiColumns);
  if (!v) return unexpected(v.error());
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> matrix(v->data());
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  const double error = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(error <= kRotationTolerance) || rotation.determinant() < 0)
    return unexpected("expected a rotation in the first three columns of the matrix, found none");
  return make_pose(0, {matrix(0, 3), matrix(1, 3), matrix(2, 3)}, Eigen::Quaterniond(rotation).normalized());
}

bool is_euroc_header(const std::string& line) {
  const Words names = split(line, ',');
  constexpr std::string_view kNames[] = {"timestamp", "p_RS_R_x", "p_RS_R_y", "p_RS_R_z",
                                         "q_RS_w",    "q_RS_x",   "q_RS_y",   "q_RS_z"};
  if (names.size() < std::size(kNames)) return false;
  for (std::size_t i = 0; i < std::size(kNames); ++i) {
    if (names[i].find(kNames[i]) == std::string_view::npos) return false;
  }
  return true;
}

bool may_head_euroc(const std::string& comment) {
  const Words names = split(comment, ',');
  return names.size() < kTumColumns || names[4].find('w') != std::string_view::npos;
}

std::string recognised_format(const std::string& header, const std::string& line) {
  const std::string& first = header.empty() ? line : header;
  if (first.find("#ROSBAG") == 0) return "this is a ROS 1 bag; export its odometry as TUM";
  if (line.find("SQLite format 3") == 0) return "this is a ROS 2 bag: use bag:FILE?topic=TOPIC";
  if (line.find("\x89MCAP") == 0) return "this is an MCAP recording: use bag:FILE?topic=TOPIC";
  const Words columns = split(line, ',');
  if (is_euroc_header(header) || (columns.size() >= kTumColumns && has_nanoseconds(columns[0])))
    return "this looks like EuRoC csv: use euroc:FILE";
  if (columns.size() >= kTumColumns) return "this looks like a csv file, of no kind that is known";
  const Words words = split(line, ' ');
  if (words.size() == kKittiColumns) return "this looks like KITTI's 3x4 poses: use kitti:FILE?times=FILE";
  if (words.size() == kTumColumns && has_nanoseconds(words[0]))
    return "this looks like TUM with nanoseconds; it has seconds";
  if (words.size() == kTumColumns) return "this looks like TUM: use tum:FILE";
  return "";
}

}  // namespace gvom::services
