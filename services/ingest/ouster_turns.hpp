// Whether whole turns are of the mode that the metadata tells of, where their packets look alike.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/ingest/ouster_metadata.hpp"

namespace gvom::ingest {

/// Half the columns in half the time, or twice as many in twice the time, lie as far apart as the metadata's:
/// only where turns begin and end tells. The frames of what does not fit are halves of turns, or two of them.
class OusterTurns {
 public:
  /// `warnings` outlives it: it says once what it found.
  OusterTurns(const OusterMetadata& metadata, std::vector<std::string>& warnings)
      : columns_(metadata.columns_per_frame), turns_per_s_(metadata.turns_per_s), warnings_(warnings) {}

  /// The frame that ends, where it is still open: its highest column, and when that was.
  struct Frame {
    int highest = -1;
    std::int64_t newest_ns = 0;
  };
  /// A frame begins with this column. @param before of the frame before; nullptr: it was complete, or none
  /// @param is_next it is that frame's successor
  void begin(const OusterColumn& first, const Frame* before, bool is_next);
  /// Whether a frame that ends with this column is to be used.
  bool fit(int highest);

 private:
  [[nodiscard]] bool turns_sooner(const OusterColumn& first, const Frame& before) const;
  [[nodiscard]] bool turns_later(const OusterColumn& first) const;
  void note_long_turn(bool is_long);
  void warn(const std::string& what);

  int columns_;
  double turns_per_s_;
  std::vector<std::string>& warnings_;
  OusterColumn begun_{};    // the first column of the frame
  int short_turn_ = 0;      // columns of a turn, if that is proven to be fewer than the metadata's
  bool long_turn_ = false;  // a turn takes longer than the metadata says: it has more columns
  bool warned_ = false;
};

}  // namespace gvom::ingest
