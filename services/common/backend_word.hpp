// The words of configuration and command line for a back end.
#pragma once

#include <optional>
#include <string_view>
#include <utility>

#include "core/backend.hpp"

namespace gvom::services {

inline constexpr std::pair<std::string_view, Backend> kBackendWords[] = {
    {"auto", Backend::automatic}, {"cpu", Backend::cpu}, {"cuda", Backend::cuda}};

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
