// A small bag in the making, and what a source makes of it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/ingest/recordings.hpp"
#include "tests/support/mcap_builder.hpp"
#include "tests/support/ros_messages.hpp"
#include "tests/tools/temporary_folder.hpp"

namespace gvom::test {

/// One topic of one type in an MCAP file.
class TopicBag {
 public:
  explicit TopicBag(const std::string& type, const std::string& encoding = "cdr")
      : channel_(file_.topic("/lidar", type, encoding)) {}

  TopicBag& add(std::int64_t log_ns, const Octets& message) {
    file_.add(channel_, log_ns, message);
    return *this;
  }
  /// The source's URI with its options: "&model=VLP-16".
  std::string uri(const std::string& options = "") {
    file_.write(folder_.path() + "/bag.mcap");
    return "bag:" + folder_.path() + "/bag.mcap?topic=/lidar" + options;
  }
  [[nodiscard]] const std::string& folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
  McapBuilder file_;
  std::uint16_t channel_;
};

inline bool same(const Return& a, const Return& b) {
  return a.x_m == b.x_m && a.y_m == b.y_m && a.z_m == b.z_m && a.time_index == b.time_index;
}

/// To the bit.
inline void require_same(const std::vector<Sweep>& a, const std::vector<Sweep>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].stamp_ns == b[i].stamp_ns);
    CHECK(a[i].times_ns == b[i].times_ns);
    CHECK(a[i].complete == b[i].complete);
    REQUIRE(a[i].returns.size() == b[i].returns.size());
    CHECK(std::equal(a[i].returns.begin(), a[i].returns.end(), b[i].returns.begin(), same));
  }
}

}  // namespace gvom::test
