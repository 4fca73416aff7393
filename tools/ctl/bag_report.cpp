#include "tools/ctl/bag_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "services/ingest/clock_check.hpp"

namespace gvom::ctl {
namespace {

constexpr double kMostClockOffset_s = 0.25;  // odometry.max_clock_offset_s unless it is set

double seconds(std::int64_t time_ns) {
  return 1e-9 * static_cast<double>(time_ns);
}

double span_s(const TimeSpan& span) {
  return seconds(span.last_ns - span.first_ns);
}

bool is_lidar(const BagTopicFacts& topic) {
  return topic.messages > 0 && (topic.use == BagTopicUse::ouster || topic.use == BagTopicUse::velodyne ||
                                topic.use == BagTopicUse::cloud);
}

/// A lidar that is mapped: IMU packets have the same type, but no such times.
bool is_usable(const BagTopicFacts& topic) {
  return is_lidar(topic) && topic.stamped > 0;
}

bool has_times(const BagTopicFacts& cloud) {
  const auto is_time = [](const std::string& field) {
    return field == "t" || field == "time" || field == "timestamp" || field == "time_stamp" ||
           field == "time_offset" || field == "offset_time";
  };
  return std::any_of(cloud.fields.begin(), cloud.fields.end(), is_time);
}

/// What ties odom to the vehicle in tf; the first link to a frame named base_..., else null.
const std::pair<std::string, std::string>* base_link_of(const BagTopicFacts& tf) {
  for (const auto& link : tf.tf)
    if (link.first == "odom" && link.second.compare(0, 4, "base") == 0) return &link;
  return nullptr;
}

/// An Odometry topic if there is one, else tf with a way from odom to base_...
const BagTopicFacts* odometry_of(const BagFacts& facts) {
  for (const BagTopicFacts& topic : facts.topics)
    if (topic.use == BagTopicUse::odometry && topic.stamped > 0) return &topic;
  for (const BagTopicFacts& topic : facts.topics)
    if (topic.use == BagTopicUse::tf && topic.stamped > 0 && base_link_of(topic) != nullptr) return &topic;
  return nullptr;
}

/// By the least delayed of each: what one clock says when the other says 0.
std::string clock_words(const BagTopicFacts& lidar, const BagTopicFacts& odometry) {
  const std::int64_t ahead_ns = odometry.least_late_ns - lidar.least_late_ns;
  if (std::abs(seconds(ahead_ns)) <= kMostClockOffset_s) return "";
  const std::string guess = ingest::guess_clock(ahead_ns, lidar.stamps.first_ns, odometry.stamps.first_ns);
  return fmt::format(
      "{}: its clock is {:.2f} s {} {}'s{}: lidars.NAME.clock_offset_s: {:.2f} would put that right{}",
      lidar.name, std::abs(seconds(ahead_ns)), ahead_ns > 0 ? "ahead of" : "behind", odometry.name,
      guess.empty() ? "" : " (" + guess + ")", -seconds(ahead_ns),
      lidar.use == BagTopicUse::cloud ? "" : ", or lidars.NAME.clock: arrival");
}

std::string model_of(const BagTopicFacts& topic) {
  switch (topic.velodyne_model_byte.value_or(0)) {
    case 0x21:
      return "HDL-32";
    case 0x22:
      return "VLP-16";
    case 0x24:
      return "Puck-Hi-Res";
    case 0x28:
      return "VLP-32C";
    case 0xA1:
      return "VLS-128";
    default:
      return "MODEL";
  }
}

/// The metadata in the same namespace as the packets; FILE.json where the bag has none.
std::string metadata_of(const BagFacts& facts, const BagTopicFacts& packets) {
  const std::string space = packets.name.substr(0, packets.name.rfind('/') + 1);
  for (const BagTopicFacts& topic : facts.topics)
    if (!topic.metadata.empty() && topic.name.compare(0, space.size(), space) == 0)
      return metadata_file(topic);
  return "FILE.json";
}

std::string source_of(const BagFacts& facts, const BagTopicFacts& topic) {
  const std::string uri = "bag:?topic=" + topic.name;
  switch (topic.use) {
    case BagTopicUse::ouster:
      return uri + "&meta=" + metadata_of(facts, topic);
    case BagTopicUse::velodyne:
      return uri + "&model=" + model_of(topic);
    default:
      return has_times(topic) ? uri : uri + "&deskew=off";
  }
}

}  // namespace

std::string bag_table(const BagFacts& facts) {
  std::size_t name = 5;
  std::size_t type = 4;
  for (const BagTopicFacts& topic : facts.topics) {
    name = std::max(name, topic.name.size());
    type = std::max(type, topic.type.size());
  }
  std::string text = fmt::format("{:{}}  {:{}}  {:>8}  {:>9}  {:>9}  {}\n", "topic", name, "type", type,
                                 "messages", "rate", "span", "recorder later than the message's own time");
  for (const BagTopicFacts& topic : facts.topics) {
    const double span = span_s(topic.log);
    const std::string rate = topic.messages > 1 && span > 0
                                 ? fmt::format("{:.1f}/s", static_cast<double>(topic.messages - 1) / span)
                                 : "-";
    const std::string late =
        topic.stamped == 0
            ? "-"
            : fmt::format("{:.3f} to {:.3f} s", seconds(topic.least_late_ns), seconds(topic.most_late_ns));
    text += fmt::format("{:{}}  {:{}}  {:>8}  {:>9}  {:>7.1f} s  {}\n", topic.name, name, topic.type, type,
                        topic.messages, rate, span, late);
  }
  return text;
}

std::vector<std::string> bag_problems(const BagFacts& facts) {
  std::vector<std::string> out;
  const BagTopicFacts* const odometry = odometry_of(facts);
  if (odometry == nullptr)
    out.emplace_back(
        "no odometry in it: neither nav_msgs/msg/Odometry nor tf from odom to base_link; gvom-map --odometry "
        "takes it from elsewhere");
  const bool any_lidar = std::any_of(facts.topics.begin(), facts.topics.end(), is_usable);
  if (!any_lidar)
    out.emplace_back("no lidar in it that is read: neither packets of an Ouster or a Velodyne nor clouds");
  for (const BagTopicFacts& topic : facts.topics) {
    if (topic.steps_back > 0)
      out.push_back(fmt::format("{}: its time goes back {} times: a recording that was looped?", topic.name,
                                topic.steps_back));
    if (!is_usable(topic)) continue;
    if (topic.use == BagTopicUse::cloud && !has_times(topic))
      out.push_back(topic.name + ": its points have no times: they can't be deskewed");
    if (odometry == nullptr) continue;
    if (const std::string words = clock_words(topic, *odometry); !words.empty()) out.push_back(words);
  }
  return out;
}

std::string metadata_file(const BagTopicFacts& topic) {
  std::string name = topic.name.substr(topic.name.find_first_not_of('/'));
  std::replace(name.begin(), name.end(), '/', '_');
  return name + ".json";
}

std::string vehicle_lines(const BagFacts& facts) {
  std::string text = "name: my_vehicle\n\n";
  if (const BagTopicFacts* const odometry = odometry_of(facts)) {
    const bool is_topic = odometry->use == BagTopicUse::odometry;
    const auto* const link = base_link_of(*odometry);
    text += "odometry:\n";
    text += is_topic ? fmt::format("  source: bag:?topic={}  # the pose of {} in {}\n\n", odometry->name,
                                   odometry->child_frame_id, odometry->frame_id)
                     : fmt::format("  source: bag:?tf={}/{}{}\n\n", link->first, link->second,
                                   odometry->name == "/tf" ? "" : "&topic=" + odometry->name);
  }
  text += "lidars:\n";
  int lidars = 0;
  for (const BagTopicFacts& topic : facts.topics) {
    if (!is_usable(topic)) continue;
    text += fmt::format("  lidar{}:{}\n    source: {}\n", ++lidars,
                        topic.frame_id.empty() ? "" : "  # its frame: " + topic.frame_id,
                        source_of(facts, topic));
    text += "    # Where it sits on base_link, in metres and radians: yours to measure.\n";
    text += "    T_base_sensor: {x: 0, y: 0, z: 1, roll: 0, pitch: 0, yaw: 0}\n";
  }
  return text;
}

}  // namespace gvom::ctl
