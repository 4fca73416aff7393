// The least of an HTTP client.
#pragma once

#include <cstdint>
#include <string>

namespace gvom::test {

/// Sends `request` to 127.0.0.1:PORT and reads until the other end closes; empty if there is none.
std::string talk(std::uint16_t port, const std::string& request);

struct HttpAnswer {
  int status = 0;  ///< 0: none came.
  std::string body;
};

HttpAnswer http_get(std::uint16_t port, const std::string& path);

}  // namespace gvom::test
