// Finds the real recordings, which are not in the repository.
#pragma once

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

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

}  // namespace gvom::test
