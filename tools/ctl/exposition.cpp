#include "tools/ctl/exposition.hpp"

#include <fmt/format.h>

#include <cmath>

namespace gvom::ctl {

namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\' || c == '"') result += '\\';
    if (c == '\n')
      result += "\\n";
    else
      result += c;
  }
  return result;
}

std::string in_braces(const Labels& labels) {
  std::string text;
  for (const auto& [name, value] : labels)
    text += fmt::format("{}{}=\"{}\"", text.empty() ? "" : ",", name, escaped(value));
  return text.empty() ? "" : "{" + text + "}";
}

}  // namespace

void Exposition::add(Type type, const std::string& name, const std::string& help, const Labels& labels,
                     double value) {
  const auto [family, is_new] = families_.try_emplace(name);
  if (is_new) {
    order_.push_back(name);
    family->second = fmt::format("# HELP {} {}\n# TYPE {} {}\n", name, help, name,
                                 type == Type::counter ? "counter" : "gauge");
  }
  family->second += fmt::format("{}{} {}\n", name, in_braces(labels),
                                std::isinf(value) ? "+Inf" : fmt::format("{}", value));
}

std::string Exposition::text() const {
  std::string text;
  for (const std::string& name : order_) text += families_.at(name);
  return text;
}

}  // namespace gvom::ctl
