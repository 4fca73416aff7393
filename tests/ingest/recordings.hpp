// Finds the real recordings, which are not in the repository.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "services/ingest/source.hpp"

namespace gvom::test {

/// The folder `data` of the recordings: $GVOM_SHARED/data, else ../shared/data beside the repository.
/// Nothing, and a loud warning, if there is none.
inline std::optional<std::string> recordings() {
  const char* set = std::getenv("GVOM_SHARED");
  const std::string folder = std::string(set != nullptr ? set : GVOM_SOURCE_DIR "/../shared") + "/data";
  if (std::filesystem::is_directory(folder)) return folder;
  WARN("SKIPPED: no recordings at " + folder + " (set GVOM_SHARED)");
  return std::nullopt;
}

/// A source that must open.
inline std::unique_ptr<ingest::Source> open(const std::string& uri, ingest::SourceOptions options = {}) {
  auto source = ingest::open_source(uri, options);
  INFO(uri << ": " << (source ? "" : source.error()));
  REQUIRE(source.has_value());
  return std::move(*source);
}

/// All sweeps up to the end, which must come without an error.
inline std::vector<Sweep> all_sweeps(ingest::Source& source) {
  std::vector<Sweep> sweeps;
  for (;;) {
    Sweep sweep;
    const auto event = source.next(sweep, std::chrono::milliseconds(0));
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
  return source.error();
}

}  // namespace gvom::test
