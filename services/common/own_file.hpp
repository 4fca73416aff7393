// Small files in /tmp by which a process tells its successor something: everybody's folder, this user's file.
#pragma once

#include <optional>
#include <string>

#include <tl/expected.hpp>

namespace gvom::services {

/// Its first 4096 bytes; nothing if there is no such file. Errors, in words: it is no plain file of this
/// user, or cannot be read.
tl::expected<std::optional<std::string>, std::string> read_own(const std::string& path);

/// All of it or nothing, for a reader and when this process ends meanwhile. Errors, in words.
tl::expected<void, std::string> replace_own(const std::string& path, const std::string& text);

/// Of this boot; "unknown" where the kernel does not tell it (ProcSubset=pid).
std::string boot_id();

}  // namespace gvom::services
