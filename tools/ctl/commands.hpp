// What gvomctl does, each to its end.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "services/common/exit_code.hpp"
#include "services/common/lifecycle.hpp"
#include "services/common/vehicle_config.hpp"
#include "tools/ctl/snapshot.hpp"
#include "tools/ctl/units.hpp"

namespace gvom::ctl {

/// Besides those of services/common/exit_code.hpp.
inline constexpr int kNotWell = 1;

struct Watched {
  Expected expected;
  Surroundings surroundings;
  services::Lifecycle& lifecycle;
};

/// Listens up to `patience`, less if nothing more is to be learnt, and prints. 0: all is well, kNotWell, or
/// 69: there is no broker or it does not let us in.
int show_status(const Watched& watched, std::chrono::milliseconds patience, bool json);

/// Prints once a second, `count` times or (0) until a stop; on a terminal in place, and until q.
int show_top(const Watched& watched, std::uint64_t count);

struct MetricsOptions {
  std::string listen = "127.0.0.1:9464";  ///< IPv4 address and port; port 0: any free one.
  bool remote = false;                    ///< Addresses other than 127.0.0.0/8 are allowed.
};

/// Serves GET /metrics until a stop.
int serve_metrics(const Watched& watched, const MetricsOptions& options);

/// Prints what there is to say about the vehicle on this machine. 0, or kNotWell if there is an error.
int show_check(const services::VehicleConfig& config, bool json);

/// Prints what is in the bag at `path`, and the lines of a vehicle's file that map it; or, if `metadata_path`
/// is not empty, writes the Ouster metadata of the bag there. 0, 65 if it is no bag or has no such metadata.
int show_bag(const std::string& path, const std::string& metadata_folder);

/// Prints whom of those who run the file's change concerns (services/common/config_concerns.hpp), then has
/// systemd restart them, unless it is a `dry_run`. 0, 78 if the pools that the file asks for cannot be, 69 if
/// there is no systemd or it refuses; nothing is changed then.
int show_reload(const services::VehicleConfig& config, Units& units, const services::Lifecycle& lifecycle,
                bool dry_run);

}  // namespace gvom::ctl
