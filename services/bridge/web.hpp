// What browsers get, and which of them may connect.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace gvom::bridge {

/// Whether a page of `origin` (that header; empty: no browser) may open a websocket at `host` (that header):
/// those of `allowed`, and our own page where we are called by an address, `localhost` or a name of the local
/// network. By another name a foreign page could pass for ours (DNS rebinding).
bool is_allowed_origin(std::string_view origin, std::string_view host,
                       const std::vector<std::string>& allowed);

struct WebFile {
  std::string type;  ///< "text/html; charset=utf-8"
  std::string text;
};

/// The file that `target`, a request's path, names below `folder`; "/" is index.html, a query counts for
/// nothing. The error is what to tell: there is no such file, or the path leads elsewhere.
tl::expected<WebFile, std::string> web_file(const std::string& folder, std::string_view target);

/// Where the page is installed: share/gvom/page beside the folder of this program.
std::string installed_page();

}  // namespace gvom::bridge
