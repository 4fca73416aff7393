#include "services/bridge/web.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

namespace gvom::bridge {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostBytes = 32U << 20;

constexpr std::array<std::pair<std::string_view, std::string_view>, 10> kTypes = {{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".json", "application/json"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".ico", "image/x-icon"},
    {".woff2", "font/woff2"},
    {".txt", "text/plain; charset=utf-8"},
    {".webmanifest", "application/manifest+json"},
}};

std::string type_of(const std::string& extension) {
  const auto* found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& type) { return type.first == extension; });
  return std::string(found == kTypes.end() ? "application/octet-stream" : found->second);
}

/// Without the port.
std::string_view name_in(std::string_view host) {
  if (!host.empty() && host.front() == '[') return host.substr(0, host.find(']') + 1);
  return host.substr(0, host.find(':'));
}

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

/// Nobody else's name server can say what such a name means.
bool is_local_name(std::string_view name) {
  const bool is_address = name.front() == '[' || name.find_first_not_of("0123456789.") == name.npos;
  return is_address || name.find('.') == name.npos || ends_with(name, ".local");
}

/// Names of files as a build of the page makes them: no need to decode, nothing that leads elsewhere.
bool is_plain_path(std::string_view path) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '/' ||
           c == '.' || c == '-' || c == '_';
  };
  return path.size() <= 255 && !path.empty() && path.front() == '/' &&
         std::all_of(path.begin(), path.end(), plain) && path.find("/.") == path.npos &&
         path.find("//") == path.npos;
}

}  // namespace

bool is_allowed_origin(std::string_view origin, std::string_view host,
                       const std::vector<std::string>& allowed) {
  if (origin.empty()) return true;
  if (std::find(allowed.begin(), allowed.end(), origin) != allowed.end()) return true;
  const std::string_view name = name_in(host);
  return !name.empty() && origin == "http://" + std::string(host) && is_local_name(name);
}

tl::expected<WebFile, std::string> web_file(const std::string& folder, std::string_view target) {
  std::string path(target.substr(0, target.find_first_of("?#")));
  if (!is_plain_path(path)) return tl::unexpected(std::string("no such file"));
  if (path == "/") path = "/index.html";
  std::error_code error;
  const fs::path file = folder + path;
  // A link within the folder may lead anywhere: whoever installed it meant that.
  if (folder.empty() || !fs::is_regular_file(file, error) || fs::file_size(file, error) > kMostBytes)
    return tl::unexpected(std::string("no such file"));
  std::ifstream in(file, std::ios::binary);
  WebFile found{type_of(file.extension().string()), std::string(std::istreambuf_iterator<char>(in), {})};
  if (in.bad()) return tl::unexpected(std::string("cannot be read"));
  return found;
}

std::string installed_page() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? "" : (program.parent_path().parent_path() / "share" / "gvom" / "page").string();
}

}  // namespace gvom::bridge
