// What Cyclone says of itself: into our log, and into the error of what failed.
#pragma once

#include <string>

namespace gvom::dds {

/// From now on Cyclone's warnings and errors go to our log, at most one a second, not to stderr.
void take_cyclone_log();

/// Keeps what Cyclone says, while it is there, for an error of ours instead. One at a time in a process.
class CycloneWords {
 public:
  CycloneWords();
  ~CycloneWords();
  CycloneWords(const CycloneWords&) = delete;
  CycloneWords& operator=(const CycloneWords&) = delete;

  /// Its warnings and errors in one line, at most some hundred characters; empty: it said nothing.
  [[nodiscard]] std::string text() const;
};

}  // namespace gvom::dds
