// Prometheus's text format: families of samples.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace gvom::ctl {

using Labels = std::vector<std::pair<std::string, std::string>>;

class Exposition {
 public:
  enum class Type { gauge, counter };

  /// One sample of the family `name`; help and type are those of the family's first sample.
  void add(Type type, const std::string& name, const std::string& help, const Labels& labels, double value);

  /// Families in the order in which they began, each whole.
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::string> order_;
  std::map<std::string, std::string> families_;
};

}  // namespace gvom::ctl
