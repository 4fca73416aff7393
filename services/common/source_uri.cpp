#include "services/common/source_uri.hpp"

#include <charconv>

namespace gvom::services {

std::optional<std::string> SourceUri::option(const std::string& key) const {
  const auto found = options.find(key);
  if (found == options.end()) return std::nullopt;
  return found->second;
}

namespace {

tl::expected<void, std::string> parse_options(std::string_view query, SourceUri& uri) {
  while (!query.empty()) {
    const auto end = query.find('&');
    const std::string_view pair = query.substr(0, end);
    query = end == std::string_view::npos ? std::string_view{} : query.substr(end + 1);
    const auto equals = pair.find('=');
    if (equals == std::string_view::npos || equals == 0 || equals + 1 == pair.size()) {
      return tl::unexpected("source '" + uri.text + "': expected key=value, got '" + std::string(pair) + "'");
    }
    const std::string key(pair.substr(0, equals));
    if (!uri.options.emplace(key, std::string(pair.substr(equals + 1))).second) {
      return tl::unexpected("source '" + uri.text + "': '" + key + "' is given twice");
    }
  }
  return {};
}

}  // namespace

tl::expected<SourceUri, std::string> parse_source_uri(const std::string& text) {
  const auto colon = text.find(':');
  if (colon == std::string::npos || colon == 0) {
    return tl::unexpected("source '" + text +
                          "': expected SCHEME:PATH, e.g. ouster:FILE.pcap?meta=FILE.json");
  }
  const auto question = text.find('?', colon);
  SourceUri uri;
  uri.text = text;
  uri.scheme = text.substr(0, colon);
  uri.path = text.substr(colon + 1, question == std::string::npos ? question : question - colon - 1);
  if (uri.path.empty()) {
    return tl::unexpected(
        "source '" + text + "': nothing between ':' and '?'" +
        (uri.scheme == "bag" ? " (--bag PATH of gvom-map and gvom-run fills that in)" : ""));
  }
  if (question != std::string::npos) {
    auto parsed = parse_options(std::string_view(text).substr(question + 1), uri);
    if (!parsed) return tl::unexpected(parsed.error());
  }
  return uri;
}

tl::expected<void, std::string> check_options(const SourceUri& uri, const std::set<std::string>& allowed) {
  for (const auto& [key, value] : uri.options) {
    if (allowed.count(key) != 0) continue;
    std::string known;
    for (const auto& name : allowed) known += (known.empty() ? "" : ", ") + name;
    return tl::unexpected("source '" + uri.text + "': unknown option '" + key + "' (" + uri.scheme +
                          " takes " + (known.empty() ? "none" : known) + ")");
  }
  return {};
}

tl::expected<std::uint16_t, std::string> parse_port(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (error != std::errc{} || end != text.data() + text.size() || port == 0) {
    return tl::unexpected("'" + std::string(text) + "' is not a UDP port (1 .. 65535)");
  }
  return port;
}

tl::expected<std::optional<std::uint64_t>, std::string> number_option(const SourceUri& uri,
                                                                      const std::string& key,
                                                                      std::uint64_t most) {
  const auto text = uri.option(key);
  if (!text) return std::nullopt;
  const bool hex = text->compare(0, 2, "0x") == 0;
  std::uint64_t value = 0;
  const char* const last = text->data() + text->size();
  const auto [end, error] = std::from_chars(text->data() + (hex ? 2 : 0), last, value, hex ? 16 : 10);
  if (error == std::errc{} && end == last && value <= most) return value;
  return tl::unexpected("source '" + uri.text + "': " + key + " '" + *text +
                        "' is not a whole number of at most " + std::to_string(most));
}

tl::expected<std::optional<std::uint16_t>, std::string> port_option(const SourceUri& uri) {
  const auto text = uri.option("port");
  if (!text) return std::nullopt;
  const auto port = parse_port(*text);
  if (!port) return tl::unexpected("source '" + uri.text + "': port " + port.error());
  return *port;
}

}  // namespace gvom::services
