// Opens sources that must, or must not, open.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "services/ingest/source.hpp"
#include "tests/support/recordings.hpp"

namespace gvom::test {

/// A source that must open.
inline std::unique_ptr<ingest::Source> open(const std::string& uri, ingest::SourceOptions options = {}) {
  auto source = ingest::open_source(uri, options);
  INFO(uri << ": " << (source ? "" : source.error().what));
  REQUIRE(source.has_value());
  return std::move(*source);
}

/// All sweeps up to the end, which must come without an error. The hour: a live source that is not done when
/// its time is over says that it is idle.
inline std::vector<Sweep> all_sweeps(ingest::Source& source) {
  std::vector<Sweep> sweeps;
  for (;;) {
    Sweep sweep;
    const auto event = source.next(sweep, std::chrono::hours(1));
    INFO((event ? "" : event.error()));
    REQUIRE(event.has_value());
    REQUIRE(*event != ingest::SourceEvent::kIdle);
    if (*event == ingest::SourceEvent::kEnd) return sweeps;
    sweeps.push_back(std::move(sweep));
  }
}

/// The error of a source that must not open.
inline std::string open_error(const std::string& uri) {
  const auto source = ingest::open_source(uri, {});
  REQUIRE_FALSE(source.has_value());
  return source.error().what;
}

}  // namespace gvom::test
