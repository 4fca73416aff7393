// Reads a message by the text of its schema alone, slowly: the writers' code is not in it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace gvom::test {

/// The message as nested objects; uint8[] and int8[] become arrays of numbers. Fails the test if the schema
/// cannot be understood, the message ends too early, or bytes are left.
nlohmann::json read_message(const std::string& schema, const std::vector<std::uint8_t>& message);

}  // namespace gvom::test
