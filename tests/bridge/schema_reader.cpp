#include "tests/bridge/schema_reader.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <map>
#include <sstream>

namespace gvom::test {
namespace {

using Fields = std::vector<std::pair<std::string, std::string>>;  // type, name

class SchemaReader {
 public:
  SchemaReader(const std::string& schema, const std::vector<std::uint8_t>& message) : bytes_(message) {
    std::istringstream lines(schema);
    std::string line, current;
    while (std::getline(lines, line)) {
      if (line.compare(0, 5, "=====") == 0) continue;
      if (line.compare(0, 5, "MSG: ") == 0) {
        current = line.substr(5);
        continue;
      }
      std::istringstream words(line);
      std::string type, name;
      words >> type >> name;
      if (name.find('=') == std::string::npos) types_[current].emplace_back(type, name);
    }
  }

  nlohmann::json read() {
    REQUIRE(bytes_.size() >= 4);
    REQUIRE(std::vector<std::uint8_t>(bytes_.begin(), bytes_.begin() + 4) ==
            std::vector<std::uint8_t>{0, 1, 0, 0});
    nlohmann::json message = read_fields("");
    REQUIRE(at_ == bytes_.size());
    return message;
  }

 private:
  nlohmann::json read_fields(const std::string& type) {
    REQUIRE(types_.count(type) == 1);
    nlohmann::json object = nlohmann::json::object();
    for (const auto& [field_type, name] : types_.at(type)) object[name] = read_field(field_type, type);
    return object;
  }

  nlohmann::json read_field(const std::string& type, const std::string& within) {
    const std::size_t bracket = type.find('[');
    if (bracket == std::string::npos) return read_one(type, within);
    const std::string fixed = type.substr(bracket + 1, type.size() - bracket - 2);
    const auto count =
        fixed.empty() ? number<std::uint32_t>() : static_cast<std::uint32_t>(std::stoul(fixed));
    nlohmann::json array = nlohmann::json::array();
    for (std::uint32_t i = 0; i < count; ++i) array.push_back(read_one(type.substr(0, bracket), within));
    return array;
  }

  nlohmann::json read_one(const std::string& type, const std::string& within) {
    if (type == "uint8" || type == "byte" || type == "bool") return number<std::uint8_t>();
    if (type == "int8") return number<std::int8_t>();
    if (type == "uint16") return number<std::uint16_t>();
    if (type == "int32") return number<std::int32_t>();
    if (type == "uint32") return number<std::uint32_t>();
    if (type == "float32") return number<float>();
    if (type == "float64") return number<double>();
    if (type == "string") return text();
    // A type of the same package may go without its name.
    return read_fields(types_.count(type) == 1 ? type : package_of(type, within) + "/" + type);
  }

  std::string package_of(const std::string& type, const std::string& within) const {
    if (!within.empty()) return within.substr(0, within.find('/'));
    for (const auto& [name, fields] : types_) {
      const std::size_t slash = name.find('/');
      if (slash != std::string::npos && name.substr(slash + 1) == type) return name.substr(0, slash);
    }
    FAIL("no type " << type);
    return {};
  }

  template <typename T>
  T number() {
    while ((at_ - 4) % sizeof(T) != 0) ++at_;
    REQUIRE(at_ + sizeof(T) <= bytes_.size());
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof(T);
    return value;
  }

  std::string text() {
    const auto length = number<std::uint32_t>();
    REQUIRE(length >= 1);
    REQUIRE(at_ + length <= bytes_.size());
    std::string value(bytes_.begin() + static_cast<std::ptrdiff_t>(at_),
                      bytes_.begin() + static_cast<std::ptrdiff_t>(at_ + length));
    at_ += length;
    REQUIRE(value.back() == '\0');
    value.pop_back();
    return value;
  }

  const std::vector<std::uint8_t>& bytes_;
  std::map<std::string, Fields> types_;
  std::size_t at_ = 4;
};

}  // namespace

nlohmann::json read_message(const std::string& schema, const std::vector<std::uint8_t>& message) {
  return SchemaReader(schema, message).read();
}

}  // namespace gvom::test
