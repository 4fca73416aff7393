// Who reads the replay and how far each has come, from their Progress messages.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ipc/messages.hpp"

namespace gvom::odometry {

/// An ingest or fusion. Only what it said about this process's odometry counts: a reader that outlived an
/// earlier gvom-odometry goes on naming that one's sequence, under that one's epoch.
struct Reader {
  std::string name;
  bool announced = false;
  std::uint64_t acknowledged = 0;  ///< Every odometry up to this sequence is used or will never be.
  std::uint64_t restarts = 0;
  std::int64_t advanced_ns = 0;  ///< CLOCK_MONOTONIC when it last came further.
  std::int64_t heard_ns = 0;     ///< ... when it last said anything.
  /// An ingest's, that it had made when it first spoke after fusion began anew: that may never get them.
  std::uint64_t missed_maps = 0;
  bool will_tell_missed = false;  ///< With its next message: it need not have told of each map at once.
  ipc::Progress latest{};
};

class Readers {
 public:
  /// One reader for each lidar, and fusion. `first_epoch`: of the first odometry of this process.
  Readers(const std::vector<std::string>& lidars, std::uint64_t first_epoch);

  /// `published`: the newest odometry's sequence. A reader that began anew (its own sequence went down) never
  /// gets what was published before, so that counts as acknowledged. Returns that reader, else null.
  const Reader* take(const ipc::Progress& progress, std::uint64_t published, std::int64_t mono_ns);

  [[nodiscard]] std::vector<std::string> missing() const;  ///< Who has not announced itself.

  /// The ingest that is furthest behind, of those that announced themselves; null if none did.
  [[nodiscard]] const Reader* slowest() const;

  /// What is still to be done until all that announced themselves are through with the odometry up to
  /// `sequence` and fusion with all their maps: one line for each, empty when done. Who has not been heard
  /// of since `heard_since_ns` (CLOCK_MONOTONIC) is left out.
  [[nodiscard]] std::vector<std::string> outstanding(std::uint64_t sequence,
                                                     std::int64_t heard_since_ns = 0) const;

  [[nodiscard]] std::int64_t last_advance_ns() const;  ///< Of any; 0: none yet.
  [[nodiscard]] std::uint64_t maps_published() const;  ///< By all ingests.

 private:
  [[nodiscard]] std::uint64_t taken_by_fusion(const std::string& lidar) const;

  std::vector<Reader> ingests_;
  Reader fusion_;
  std::uint64_t first_epoch_;
};

}  // namespace gvom::odometry
