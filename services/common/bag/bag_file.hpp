// One file of a bag, of whatever kind.
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/ros/cdr_reader.hpp"

namespace gvom::bag {

using ros::Bytes;

/// Most bytes of a message, packed or not.
inline constexpr std::size_t kMostMessageBytes = 512 << 20;

struct FileTopic {
  std::string name;
  std::string type;      ///< "nav_msgs/msg/Odometry".
  std::string encoding;  ///< "cdr".
  std::uint64_t messages = 0;
};

struct FileMessage {
  std::size_t topic = 0;    ///< Of `topics()`.
  std::int64_t log_ns = 0;  ///< When the recorder got it.
  Bytes data;               ///< Valid until the file's next call.
};

class BagFile {
 public:
  virtual ~BagFile() = default;

  [[nodiscard]] virtual const std::vector<FileTopic>& topics() const = 0;
  /// When the recorder got the first message and the last one; both 0 where there is none.
  [[nodiscard]] virtual std::int64_t first_ns() const = 0;
  [[nodiscard]] virtual std::int64_t last_ns() const = 0;

  /// Only these topics from now on, from the beginning.
  virtual tl::expected<void, std::string> select(const std::set<std::size_t>& topics) = 0;
  /// False at the end; in order of time. After an error nothing more comes.
  virtual tl::expected<bool, std::string> next(FileMessage& out) = 0;

  /// Pieces that were left out since they are damaged; `warnings` name the first ones.
  [[nodiscard]] virtual std::uint64_t damaged() const = 0;
  [[nodiscard]] virtual const std::vector<std::string>& warnings() const = 0;
};

using FileResult = tl::expected<std::unique_ptr<BagFile>, std::string>;

/// True for names that end with .db3 or .mcap, or these with .zstd behind.
bool is_bag_file(const std::string& path);

/// Opens `path` by its name's end; what zstd packed is unpacked into the folder for temporary files. Errors
/// name the file.
FileResult open_bag_file(const std::string& path);

/// `path`: the file to read; `name`: what it is called in messages.
FileResult open_db3(const std::string& path, const std::string& name);
FileResult open_mcap(const std::string& path, const std::string& name);

}  // namespace gvom::bag
