// Source URIs: `scheme:path?key=value&key=value`.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace gvom::services {

/// A URI in its parts. `path` is what stands between ':' and '?': a file, a folder or a UDP port.
struct SourceUri {
  std::string text;  ///< The whole URI, for messages.
  std::string scheme;
  std::string path;
  std::map<std::string, std::string> options;

  /// The option's value, or nothing.
  [[nodiscard]] std::optional<std::string> option(const std::string& key) const;
};

/// Errors: no scheme, empty path, an option without '=' or value, an option given twice.
tl::expected<SourceUri, std::string> parse_source_uri(const std::string& text);

/// Error that names the first option which is not in `allowed`.
tl::expected<void, std::string> check_options(const SourceUri& uri, const std::set<std::string>& allowed);

/// A UDP port, 1 .. 65535.
tl::expected<std::uint16_t, std::string> parse_port(std::string_view text);

/// The option `key` as a whole number of at most `most`, if it is there: decimal, or hexadecimal behind 0x.
tl::expected<std::optional<std::uint64_t>, std::string> number_option(const SourceUri& uri,
                                                                      const std::string& key,
                                                                      std::uint64_t most);

/// The option `port`, if it is there.
tl::expected<std::optional<std::uint16_t>, std::string> port_option(const SourceUri& uri);

}  // namespace gvom::services
