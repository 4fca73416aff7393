// A course's file is read whole, or refused with its line.
#include <catch2/catch.hpp>

#include "services/planner/process/course_file.hpp"
#include "tests/common/temporary_file.hpp"

using gvom::planner::read_course;
using gvom::test::TemporaryFile;

namespace {

std::string error_of(const std::string& content, std::size_t most = 10) {
  const TemporaryFile file(content);
  const auto course = read_course(file.path(), most);
  REQUIRE_FALSE(course);
  const std::string& error = course.error();
  REQUIRE(error.rfind(file.path(), 0) == 0);
  return error.substr(file.path().size());
}

}  // namespace

TEST_CASE("places, one a line, with or without a title, comments and blanks") {
  for (const char* text : {"1.5,-2\n30, 40.25 \n", "x_m,y_m\n1.5,-2\r\n\n# a tree\n30,40.25"}) {
    const TemporaryFile file(text);
    const auto course = read_course(file.path(), 2);
    REQUIRE(course);
    REQUIRE(course->size() == 2);
    CHECK((*course)[0] == Eigen::Vector2d(1.5, -2));
    CHECK((*course)[1] == Eigen::Vector2d(30, 40.25));
  }
}

TEST_CASE("what is no place is named with its line") {
  CHECK(error_of("1,2\n3;4\n") == ":2: expected x_m,y_m, found '3;4'");
  CHECK(error_of("1,2,3\n") == ":1: expected x_m,y_m, found '1,2,3'");
  CHECK(error_of("x,y\nx,y\n") == ":2: expected x_m,y_m, found 'x,y'");
  CHECK(error_of("1,\n") == ":1: expected x_m,y_m, found '1,'");
  CHECK(error_of("nan,1\n") == ":1: a place within 10,000 km expected, found 'nan,1'");
  CHECK(error_of("1,nan\n") == ":1: a place within 10,000 km expected, found '1,nan'");
  CHECK(error_of("1,2e7\n") == ":1: a place within 10,000 km expected, found '1,2e7'");
  CHECK(error_of("1,1\n2,2\n3,3\n", 2) == ":3: more than 2 places");
  CHECK(error_of("x_m,y_m\n") == ": no place in it");
  CHECK(error_of("") == ": no place in it");
  CHECK_FALSE(read_course("/nowhere/course.csv", 1));
}
