// How the messages of a topic are kept, and for whom.
#pragma once

namespace gvom::dds {

struct Qos {
  bool reliable =
      true;  ///< A writer sends again what a reader missed; a reader takes from such writers only.
  bool latched = false;  ///< The newest `depth` are for readers that come later too (transient local).
  int depth = 1;         ///< Messages kept.
};

}  // namespace gvom::dds
