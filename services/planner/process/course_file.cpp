#include "services/planner/process/course_file.hpp"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "services/common/line_reader.hpp"

namespace gvom::planner {
namespace {

constexpr double kFarthest_m = 1e7;

std::string_view without_blanks(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> number_of(std::string_view text) {
  text = without_blanks(text);
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{} || result.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<Eigen::Vector2d> place_of(const std::string& line) {
  const std::size_t comma = line.find(',');
  if (comma == std::string::npos) return std::nullopt;
  const std::string_view text = line;
  const auto x_m = number_of(text.substr(0, comma)), y_m = number_of(text.substr(comma + 1));
  if (!x_m || !y_m) return std::nullopt;
  return Eigen::Vector2d(*x_m, *y_m);
}

bool begins_with_letter(const std::string& line) {
  const std::string_view text = without_blanks(line);
  return !text.empty() && ((text[0] >= 'a' && text[0] <= 'z') || (text[0] >= 'A' && text[0] <= 'Z')) &&
         !number_of(text.substr(0, text.find(',')));
}

}  // namespace

tl::expected<std::vector<Eigen::Vector2d>, std::string> read_course(const std::string& path,
                                                                    std::size_t most) {
  services::LineReader lines(path);
  std::vector<Eigen::Vector2d> course;
  bool first = true;
  while (lines.next()) {
    if (lines.text()[0] == '#') continue;
    const bool title = first && begins_with_letter(lines.text());
    first = false;
    if (title) continue;
    const auto place = place_of(lines.text());
    if (!place) return tl::unexpected(lines.where() + "expected x_m,y_m, found '" + lines.text() + "'");
    if (!place->allFinite() || place->cwiseAbs().maxCoeff() > kFarthest_m)
      return tl::unexpected(lines.where() + "a place within 10,000 km expected, found '" + lines.text() +
                            "'");
    if (course.size() == most)
      return tl::unexpected(lines.where() + "more than " + std::to_string(most) + " places");
    course.push_back(*place);
  }
  if (!lines.error().empty()) return tl::unexpected(lines.error());
  if (course.empty()) return tl::unexpected(path + ": no place in it");
  return course;
}

}  // namespace gvom::planner
