// A snapshot for people, for scripts and for Prometheus.
#pragma once

#include <string>

#include "tools/ctl/snapshot.hpp"

namespace gvom::ctl {

/// Lines of at most 120 characters, but for reasons and details.
std::string to_table(const Snapshot& snapshot);

/// One object; what is not known is null.
std::string to_json(const Snapshot& snapshot);

/// Prometheus's text format, version 0.0.4. Seconds and bytes; gvom_drops_total{process, reason} and
/// gvom_NAME_total{process} are the counters of Health.
std::string to_prometheus(const Snapshot& snapshot);

}  // namespace gvom::ctl
