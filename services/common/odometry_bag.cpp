#include "services/common/odometry_bag.hpp"

#include <map>
#include <optional>
#include <utility>

#include "services/common/bag/bag_reader.hpp"
#include "services/common/odometry_lines.hpp"
#include "services/common/odometry_tf.hpp"
#include "services/common/ros/incoming.hpp"
#include "services/common/source_uri.hpp"
#include "services/common/stamps.hpp"

namespace gvom::services {
namespace {

using Poses = tl::expected<std::vector<StampedPose>, std::string>;
using Result = tl::expected<void, std::string>;

const std::string kStaticTopic = "/tf_static";
constexpr std::int64_t kFarAheadNs = 10'000'000'000;
constexpr std::size_t kMostAhead = 8;  // as many as PoseJudge gets over

struct BagSource {
  std::string path;
  std::optional<std::string> topic;
  std::optional<Frames> tf;
};

tl::expected<BagSource, std::string> parse(const std::string& source) {
  const auto wrong = [](const std::string& why) {
    return tl::unexpected("odometry " + why + "; expected bag:PATH?topic=TOPIC or bag:PATH?tf=PARENT/CHILD");
  };
  const auto uri = parse_source_uri(source);
  if (!uri) return wrong(uri.error());
  if (const auto checked = check_options(*uri, {"topic", "tf"}); !checked) return wrong(checked.error());
  BagSource out{uri->path, uri->option("topic"), {}};
  if (const auto text = uri->option("tf")) {
    auto frames = parse_frames(*text);
    if (!frames) return wrong("source '" + source + "': " + frames.error());
    out.tf = std::move(*frames);
  }
  if (!out.topic && !out.tf) return wrong("source '" + source + "': no topic and no tf");
  return out;
}

/// Poses in order of time, and how many were left out for which reason.
class Collector {
 public:
  explicit Collector(std::string name) : name_(std::move(name)) {}

  void add(const PoseResult& pose, std::uint64_t message) {
    if (!pose) return leave_out("", message, pose.error());
    drop_far_ahead(pose->stamp_ns, message);
    if (!poses_.empty() && pose->stamp_ns <= poses_.back().stamp_ns) {
      return leave_out(" that do not go on in time (a looped bag?)", message,
                       stamp_text(pose->stamp_ns) + " s after " + stamp_text(poses_.back().stamp_ns) + " s");
    }
    poses_.push_back(*pose);
  }

  /// A few poses before this one, far later than it, were of a time that was not yet: not all that follow
  /// them are wrong.
  void drop_far_ahead(std::int64_t stamp_ns, std::uint64_t message) {
    std::size_t ahead = 0;
    while (ahead < poses_.size() && poses_[poses_.size() - 1 - ahead].stamp_ns >= stamp_ns + kFarAheadNs)
      ++ahead;
    if (ahead == 0 || ahead > kMostAhead || ahead == poses_.size()) return;
    for (; ahead > 0; --ahead, poses_.pop_back())
      leave_out(" far ahead of those that follow", message,
                stamp_text(stamp_ns) + " s after " + stamp_text(poses_.back().stamp_ns) + " s");
  }

  void leave_out(const std::string& kind, std::uint64_t message, const std::string& reason) {
    const std::string text = "message " + std::to_string(message) + ": " + reason;
    ++left_out_.try_emplace(kind, Left{0, text}).first->second.count;
  }

  Poses take(std::vector<std::string>& warnings) {
    const std::string first = left_out_.empty() ? "" : ": " + left_out_.begin()->second.first;
    if (poses_.empty()) return tl::unexpected(name_ + ": no pose in it" + first);
    for (const auto& [kind, left] : left_out_) {
      warnings.push_back(name_ + ": left out " + std::to_string(left.count) +
                         (left.count == 1 ? " pose" : " poses") + kind + "; the first: " + left.first);
    }
    return std::move(poses_);
  }

 private:
  struct Left {
    std::uint64_t count;
    std::string first;
  };

  std::string name_;
  std::vector<StampedPose> poses_;
  std::map<std::string, Left> left_out_;
};

tl::expected<bag::BagReader, std::string> open(const std::string& path,
                                               const std::vector<std::string>& topics,
                                               const std::string& type) {
  auto reader = bag::BagReader::open(path, topics);
  if (!reader) return reader;
  for (const std::string& name : topics) {
    const bag::Topic& topic = *reader->find(name).front();
    if (topic.type != type || topic.encoding != "cdr")
      return tl::unexpected(path + " " + name + ": is of type " + topic.type + " in " + topic.encoding +
                            "; " + type + " in cdr is needed");
  }
  return reader;
}

Poses read_topic(const BagSource& source, std::vector<std::string>& warnings) {
  auto reader = open(source.path, {*source.topic}, "nav_msgs/msg/Odometry");
  if (!reader) return tl::unexpected(reader.error());
  Collector poses(source.path + " " + *source.topic);
  std::optional<std::string> child;
  bag::Message message;
  while (reader->next(message)) {
    ros::OdometryIn odometry;
    if (const auto read = ros::read_odometry(message.data, odometry); !read) {
      poses.leave_out("", message.number, read.error());
      continue;
    }
    if (!child) child = std::string(odometry.child_frame_id);
    if (*child != odometry.child_frame_id) {
      poses.leave_out(" of another frame", message.number,
                      std::string(odometry.child_frame_id) + ", not " + *child);
      continue;
    }
    const auto& p = odometry.position_m;
    const auto& q = odometry.orientation_xyzw;
    poses.add(make_pose(odometry.header.stamp_ns, {p[0], p[1], p[2]}, {q[3], q[0], q[1], q[2]}),
              message.number);
  }
  warnings.insert(warnings.end(), reader->warnings().begin(), reader->warnings().end());
  return poses.take(warnings);
}

/// Twice through the bag: what links there are, then the poses.
Poses read_tf(const BagSource& source, std::vector<std::string>& warnings) {
  const std::string topic = source.topic.value_or("/tf");
  const std::string name = source.path + " " + topic;
  const std::string type = "tf2_msgs/msg/TFMessage";
  std::vector<std::string> topics{topic};
  auto reader = open(source.path, topics, type);
  if (!reader) return tl::unexpected(reader.error());
  if (!reader->find(kStaticTopic).empty() && topic != kStaticTopic) {
    topics.push_back(kStaticTopic);
    reader = open(source.path, topics, type);
    if (!reader) return tl::unexpected(reader.error());
  }
  Collector poses(name);
  TfLinks links;
  bag::Message message;
  std::vector<ros::TransformIn> transforms;
  while (reader->next(message)) {
    const auto read = ros::read_transforms(message.data, transforms);
    if (!read) poses.leave_out("", message.number, read.error());
    for (const ros::TransformIn& transform : transforms)
      if (read) links.see(transform);
  }
  auto chain = links.chain(source.tf->first, source.tf->second);
  if (!chain) return tl::unexpected(name + ": " + chain.error());
  reader->rewind();
  while (reader->next(message)) {
    if (!ros::read_transforms(message.data, transforms)) continue;  // counted before
    for (const ros::TransformIn& transform : transforms)
      if (chain->is_moving(transform)) poses.add(chain->pose_by(transform), message.number);
  }
  warnings.insert(warnings.end(), reader->warnings().begin(), reader->warnings().end());
  return poses.take(warnings);
}

}  // namespace

Poses read_bag_odometry(const std::string& source, std::vector<std::string>& warnings) {
  const auto parsed = parse(source);
  if (!parsed) return tl::unexpected(parsed.error());
  return parsed->tf ? read_tf(*parsed, warnings) : read_topic(*parsed, warnings);
}

}  // namespace gvom::services
