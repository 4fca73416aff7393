// Reads the keys of a JSON object that a person wrote, and says what is wrong with them.
#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace gvom::sim {

/// The first thing that is wrong, in words; empty: nothing.
struct Complaint {
  std::string text;

  void say(const std::string& what) {
    if (text.empty()) text = what;
  }
};

/// Bounds of a number, both allowed.
struct Bounds {
  double low;
  double high;
};

/// What is missing, mistyped or out of bounds becomes the complaint and reads as 0.
class JsonKeys {
 public:
  /// `where` is what a complaint begins with, for instance "objects.json: object 3: ". Both must outlive it.
  JsonKeys(const nlohmann::json& json, std::string where, Complaint& complaint);

  [[nodiscard]] bool has(const char* key) const { return json_.is_object() && json_.contains(key); }
  /// Complains of every other key.
  void allow_only(std::initializer_list<const char*> keys) const;

  double number(const char* key, const Bounds& bounds) const;
  double number_or(const char* key, const Bounds& bounds, double otherwise) const;
  std::string word(const char* key) const;
  /// `size` numbers, metres within 100 km.
  Eigen::VectorXd point(const char* key, int size) const;
  Eigen::Vector3d point_or(const char* key, const Eigen::Vector3d& otherwise) const;
  /// A list; an empty one if it is none.
  const nlohmann::json& list(const char* key) const;
  /// The numbers of `json`, a list of `size` of them.
  Eigen::VectorXd numbers(const nlohmann::json& json, const char* key, int size) const;

  void complain(const std::string& what) const { complaint_.say(where_ + what); }
  [[nodiscard]] const std::string& where() const { return where_; }

 private:
  [[nodiscard]] const nlohmann::json* find(const char* key) const;

  const nlohmann::json& json_;
  std::string where_;
  Complaint& complaint_;
};

}  // namespace gvom::sim
