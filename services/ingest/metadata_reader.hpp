// The keys of an Ouster's metadata JSON, with the errors that they can have.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace gvom::ingest {

using Json = nlohmann::json;

/// A value for a message: short, and of a nested one only what it is (text is made of it recursively).
inline std::string shown(const Json& json) {
  constexpr std::size_t kLongest = 60;
  if (json.is_structured()) return std::string("an ") + json.type_name();
  const std::string text = json.dump();
  return text.size() <= kLongest
             ? text
             : std::string(json.type_name()) + " of " + std::to_string(text.size()) + " characters";
}

inline std::string text_of(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

/// Reads keys one by one and remembers the first thing that is wrong.
class MetadataReader {
 public:
  MetadataReader(const Json& root, std::string path, std::vector<std::string>& warnings)
      : root_(root), path_(std::move(path)), warnings_(warnings) {}

  /// `key` in the first of `sections` that has it, else at the top; null if it is nowhere.
  const Json* find(std::initializer_list<const char*> sections, const char* key) const {
    for (const char* section : sections) {
      const auto found = root_.find(section);
      if (found != root_.end() && found->is_object() && found->contains(key)) return &(*found)[key];
    }
    const auto found = root_.find(key);
    return found == root_.end() ? nullptr : &*found;
  }

  std::vector<double> numbers(const Json& json, const char* key, double limit) {
    std::vector<double> values;
    if (!json.is_array()) fail(key, "expected a list of numbers");
    for (const Json& item : json) {
      const double value = item.is_number() ? item.get<double>() : std::nan("");
      if (!(std::abs(value) <= limit)) {
        fail(key, "expected numbers of at most " + std::to_string(static_cast<int>(limit)) + ", got " +
                      shown(item));
        break;
      }
      values.push_back(value);
    }
    return values;
  }

  int integer(const Json& json, const char* key, int low, int high) {
    const bool fits = json.is_number_integer() && json >= low && json <= high;
    if (fits) return json.get<int>();
    fail(key, "expected a whole number of " + std::to_string(low) + " .. " + std::to_string(high) + ", got " +
                  shown(json));
    return low;
  }

  void fail(const std::string& key, const std::string& reason) {
    if (error_.empty()) error_ = path_ + ": " + key + ": " + reason;
  }
  void warn(const std::string& text) { warnings_.push_back(path_ + ": " + text); }
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  const Json& root_;
  std::string path_;
  std::vector<std::string>& warnings_;
  std::string error_;
};

}  // namespace gvom::ingest
