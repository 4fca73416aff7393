// The words of configuration and command line for a back end, and for a clock.
#pragma once

#include <optional>
#include <string_view>
#include <utility>

#include "core/backend.hpp"
#include "services/common/vehicle_config.hpp"

namespace gvom::services {

inline constexpr std::pair<std::string_view, Backend> kBackendWords[] = {
    {"auto", Backend::automatic}, {"cpu", Backend::cpu}, {"cuda", Backend::cuda}};

inline constexpr std::pair<std::string_view, LidarClock> kClockWords[] = {{"sensor", LidarClock::sensor},
                                                                          {"arrival", LidarClock::arrival}};

inline std::optional<Backend> backend_of(std::string_view word) {
  for (const auto& [known, backend] : kBackendWords)
    if (known == word) return backend;
  return std::nullopt;
}

inline std::string_view word_of(Backend backend) {
  for (const auto& [word, known] : kBackendWords)
    if (known == backend) return word;
  return {};
}

}  // namespace gvom::services
