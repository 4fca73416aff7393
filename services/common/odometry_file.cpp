#include "services/common/odometry_file.hpp"

#include <utility>

#include "services/common/line_reader.hpp"
#include "services/common/odometry_bag.hpp"
#include "services/common/odometry_lines.hpp"
#include "services/common/stamps.hpp"

namespace gvom::services {

namespace {

using Poses = tl::expected<std::vector<StampedPose>, std::string>;

/// A format with its stamps in it.
struct Format {
  std::string scheme;
  PoseResult (*parse)(const std::string& line);
};

const Format kTum = {"tum:", parse_tum_line};
const Format kEuroc = {"euroc:", parse_euroc_line};
const std::string kKitti = "kitti:";

/// Poses in order of time; counts those that repeat a stamp.
class PoseList {
 public:
  explicit PoseList(std::string path) : path_(std::move(path)) {}

  [[nodiscard]] bool empty() const { return poses_.empty(); }
  [[nodiscard]] std::int64_t newest_ns() const { return poses_.back().stamp_ns; }

  /// False if `pose` is before the one in front of it.
  bool add(const StampedPose& pose, int line) {
    if (poses_.empty() || pose.stamp_ns > poses_.back().stamp_ns) {
      poses_.push_back(pose);
      return true;
    }
    if (pose.stamp_ns < poses_.back().stamp_ns) return false;
    if (repeated_++ == 0) first_repeated_line_ = line;
    const Pose& kept = poses_.back().T_odom_base;
    if (pose.T_odom_base.translation_m != kept.translation_m ||
        pose.T_odom_base.rotation.coeffs() != kept.rotation.coeffs())
      ++different_;
    return true;
  }

  Poses take(std::vector<std::string>& warnings) {
    if (poses_.empty()) return tl::make_unexpected(path_ + ": no pose in it");
    constexpr std::size_t kSeveral = 10;
    if (different_ >= kSeveral && different_ * 10 > poses_.size()) {
      return tl::make_unexpected(path_ + ": " + std::to_string(different_) +
                                 " poses have the stamp of another " + "pose, the first in line " +
                                 std::to_string(first_repeated_line_) + ": its times have too few digits");
    }
    if (repeated_ > 0) {
      warnings.push_back(path_ + ": left out " + std::to_string(repeated_) +
                         (repeated_ == 1 ? " pose" : " poses") + " with the stamp of the pose before, " +
                         std::to_string(different_) + " of them at another place; the first is in line " +
                         std::to_string(first_repeated_line_));
    }
    return std::move(poses_);
  }

 private:
  std::string path_;
  std::vector<StampedPose> poses_;
  std::size_t repeated_ = 0;
  std::size_t different_ = 0;  // of the repeated ones, those that say another pose
  int first_repeated_line_ = 0;
};

std::string expected_time_to_go_on(const LineReader& lines, std::int64_t from_ns, std::int64_t found_ns) {
  return lines.where() + "expected time to go on from " + stamp_text(from_ns) + " s, found " +
         stamp_text(found_ns) + " s";
}

/// `scheme`: what it was read as; another format that the first line seems to have is named.
std::string refusal(const LineReader& lines, const std::string& reason, const std::string& header,
                    const std::string& scheme) {
  const std::string format = recognised_format(header, lines.text());
  const bool helps = !format.empty() && format.find("use " + scheme) == std::string::npos;
  return lines.where() + reason + (helps ? "; " + format : "");
}

bool is_comment(const std::string& line) {
  return line[line.find_first_not_of(" \t")] == '#';
}

Poses read_stamped(const std::string& path, const Format& format, std::vector<std::string>& warnings) {
  LineReader lines(path);
  PoseList poses(path);
  std::string header;
  while (lines.next()) {
    const bool names = &format == &kEuroc && poses.empty() && is_euroc_header(lines.text());
    if (is_comment(lines.text()) || names) {
      header = lines.text();
      continue;
    }
    if (poses.empty() && &format == &kTum && is_euroc_header(header)) {
      warnings.push_back(path + ": is EuRoC csv, and read as such (euroc:FILE)");
      return read_stamped(path, kEuroc, warnings);
    }
    if (poses.empty() && &format == &kEuroc && !may_head_euroc(header))
      return tl::make_unexpected(path + ": its column names are not EuRoC's: " + header);
    const auto pose = format.parse(lines.text());
    if (!pose && !poses.empty()) return tl::make_unexpected(lines.where() + pose.error());
    if (!pose) return tl::make_unexpected(refusal(lines, pose.error(), header, format.scheme));
    if (!poses.add(*pose, lines.number()))
      return tl::make_unexpected(expected_time_to_go_on(lines, poses.newest_ns(), pose->stamp_ns));
  }
  if (!lines.error().empty()) return tl::make_unexpected(lines.error());
  return poses.take(warnings);
}

Poses read_kitti(const std::string& path, const std::string& times_path, std::vector<std::string>& warnings) {
  const auto times = read_stamps(times_path);
  if (!times) return tl::make_unexpected(times.error());
  LineReader lines(path);
  PoseList poses(path);
  std::size_t count = 0;
  while (lines.next()) {
    if (is_comment(lines.text())) continue;
    auto pose = parse_kitti_line(lines.text());
    if (!pose) return tl::make_unexpected(refusal(lines, pose.error(), "", kKitti));
    if (count < times->size()) {
      pose->stamp_ns = (*times)[count].stamp_ns;
      if (!poses.add(*pose, lines.number()))
        return tl::make_unexpected(expected_time_to_go_on(lines, poses.newest_ns(), pose->stamp_ns));
    }
    ++count;
  }
  if (!lines.error().empty()) return tl::make_unexpected(lines.error());
  if (count != times->size()) {
    return tl::make_unexpected(path + ": " + std::to_string(count) + " poses, but " + times_path + " has " +
                               std::to_string(times->size()) + " times");
  }
  return poses.take(warnings);
}

}  // namespace

tl::expected<std::vector<StampedPose>, std::string> read_odometry_source(const std::string& source,
                                                                         std::vector<std::string>& warnings) {
  const std::size_t colon = source.find(':');
  const std::string scheme = source.substr(0, colon == std::string::npos ? 0 : colon + 1);
  const std::string file = source.substr(scheme.size());
  if (scheme == kTum.scheme && !file.empty()) return read_stamped(file, kTum, warnings);
  if (scheme == kEuroc.scheme && !file.empty()) return read_stamped(file, kEuroc, warnings);
  if (scheme == "bag:") return read_bag_odometry(source, warnings);
  const std::string option = "?times=";
  const std::size_t times = file.rfind(option);
  if (scheme == kKitti && times != std::string::npos)
    return read_kitti(file.substr(0, times), file.substr(times + option.size()), warnings);
  return tl::make_unexpected(
      "odometry source '" + source +
      "': expected tum:FILE, euroc:FILE, kitti:FILE?times=FILE, bag:PATH?topic=TOPIC or "
      "bag:PATH?tf=PARENT/CHILD");
}

}  // namespace gvom::services
