// bridge.foxglove.address, as it is written and as a server takes it.
#pragma once

#include <boost/asio/ip/address.hpp>
#include <string>

#include <tl/expected.hpp>

namespace gvom::bridge {

/// The error names what is no address.
inline tl::expected<boost::asio::ip::address, std::string> parse_address(const std::string& text) {
  boost::system::error_code fault;
  const auto address = boost::asio::ip::make_address(text, fault);
  if (fault) return tl::unexpected("'" + text + "' is no IP address");
  return address;
}

}  // namespace gvom::bridge
