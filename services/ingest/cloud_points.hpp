// Points of a cloud as returns of a sweep, whichever file or message the cloud is of.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/sweep.hpp"
#include "services/ingest/hits.hpp"
#include "services/ingest/pcd.hpp"

namespace gvom::ingest {

/// Appends the first `count` points to `out.returns`, their times not known yet, and says of each whether it
/// is a hit. An error without floating-point fields x, y, z, and if most hits cannot be in metres.
tl::expected<Hits, std::string> take_points(const PcdCloud& cloud, std::size_t count, Sweep& out,
                                            std::vector<bool>& is_hit);

/// Gives the returns of `out` their times, one a return; `stamp_ns` is the sweep's time if it has no return.
void set_times(const std::vector<std::int64_t>& times_ns, std::int64_t stamp_ns, Sweep& out);

}  // namespace gvom::ingest
