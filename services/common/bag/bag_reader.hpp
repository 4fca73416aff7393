// A ROS 2 bag as it was recorded: a folder of rosbag2, or one of its files.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/bag/bag_file.hpp"
#include "services/common/bag/zstd_unpack.hpp"

namespace gvom::bag {

/// Topics of one name with different types are different topics.
struct Topic {
  std::string name;
  std::string type;      ///< "nav_msgs/msg/Odometry".
  std::string encoding;  ///< Of the messages: "cdr".
  std::uint64_t messages = 0;
};

struct Message {
  const Topic* topic = nullptr;
  std::uint64_t number = 0;  ///< Of this topic's messages, from 1.
  std::int64_t log_ns = 0;   ///< When the recorder got it, which is later than the message's own stamp.
  Bytes data;                ///< CDR with its head; valid until the next call.
};

/// The messages of all files of a bag in order of the recorder's time, whose clock may have been set while it
/// recorded. Damaged or missing pieces are left out, counted and named; the rest is read.
class BagReader {
 public:
  /// `path`: a folder with .db3 or .mcap files (packed by zstd, or not), or one such file. `topics`: those
  /// whose messages are wanted, all if it is empty. Errors: no bag there; no file of it can be read; a topic
  /// that it does not have (the error lists those that it has).
  static tl::expected<BagReader, std::string> open(const std::string& path,
                                                   const std::vector<std::string>& topics);

  /// Of the whole bag, in order of their names.
  [[nodiscard]] const std::vector<std::unique_ptr<Topic>>& topics() const { return topics_; }
  /// Those of this name; empty if there is none.
  [[nodiscard]] std::vector<const Topic*> find(const std::string& name) const;
  /// When the recorder got the first message of the bag and the last one; both 0 where there is none.
  [[nodiscard]] std::int64_t first_ns() const { return first_ns_; }
  [[nodiscard]] std::int64_t last_ns() const { return last_ns_; }

  /// False at the end.
  bool next(Message& out);
  /// From the first message again.
  void rewind();

  [[nodiscard]] std::uint64_t damaged() const { return damaged_; }
  /// What a person should hear of; more may come while messages are read.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  /// A file: open only while its time has come.
  struct Part {
    std::string path;
    std::int64_t first_ns = 0;
    std::vector<Topic*> topics;  // of the file's, in its order
    std::set<std::size_t> wanted;
    bool begun = false;
    std::unique_ptr<BagFile> file;
    FileMessage head;
    std::size_t warnings_told = 0;
    std::uint64_t damaged_told = 0;
  };

  BagReader() = default;
  tl::expected<void, std::string> add_part(const std::string& path);
  tl::expected<void, std::string> want(const std::string& path, const std::vector<std::string>& topics);
  Topic* topic_of(const FileTopic& topic);
  void begin(Part& part);
  void advance(Part& part);
  Part* earliest();
  void restart();
  void note(Part& part);
  void count_damage() { damaged_ += first_round_ ? 1 : 0; }
  void warn(const std::string& text);

  std::vector<std::unique_ptr<Topic>> topics_;
  std::vector<Part> parts_;  // in order of their first times
  std::set<const Topic*> wanted_;
  Part* last_ = nullptr;  // whose message was given out
  MessageUnpacker unpacker_;
  std::map<const Topic*, std::uint64_t> numbers_;
  bool first_round_ = true;
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
  bool any_message_ = false;
  std::uint64_t damaged_ = 0;
  std::set<std::string> told_;
  std::vector<std::string> warnings_;
};

}  // namespace gvom::bag
