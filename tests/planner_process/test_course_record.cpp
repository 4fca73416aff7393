// What a planner that dies leaves of its course, and what its successor makes of it.
#include "services/planner/process/course_record.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/tools/temporary_folder.hpp"

namespace gvom::test {
namespace {

using planner::CourseName;
using planner::CourseRecord;
using planner::name_of;
using Places = std::vector<Eigen::Vector2d>;

struct Folder {
  TemporaryFolder folder;
  std::string path = folder.path() + "/gvom-planner.course";
  /// As a planner that has just started.
  [[nodiscard]] std::size_t place_of(const CourseName& name) const {
    return CourseRecord(path).place_of(name);
  }
  [[nodiscard]] std::string text() const {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::string& text) const { std::ofstream(path) << text; }
};

const Places kPlaces{{1, 2}, {3, 4}, {5, 6}};

TEST_CASE("a successor knows the place that was driven to, of this course and no other") {
  const Folder folder;
  const CourseName name = name_of(7, 3, kPlaces);
  CHECK(folder.place_of(name) == 0);
  CourseRecord record(folder.path);
  record.note(name, 1);
  CHECK(folder.place_of(name) == 1);
  record.note(name, 2);
  CHECK(folder.place_of(name) == 2);
  CHECK(folder.place_of(name_of(8, 3, kPlaces)) == 0);
  CHECK(folder.place_of(name_of(7, 4, kPlaces)) == 0);
  CHECK(folder.place_of(name_of(7, 3, {{1, 2}, {3, 4}, {5, 7}})) == 0);
  CHECK(folder.place_of(name_of(7, 3, {{1, 2}, {3, 4}})) == 0);
  record.forget();
  CHECK(folder.place_of(name) == 0);
  record.note(name, 2);
  CHECK(folder.place_of(name) == 2);
}

TEST_CASE("a record that is damaged, of another boot, or no plain file is none") {
  const Folder folder;
  const CourseName name = name_of(0, 0, kPlaces);
  CourseRecord(folder.path).note(name, 2);
  const std::string good = folder.text();
  for (std::size_t size = 0; size < good.size(); ++size) {
    folder.write(good.substr(0, size));
    CAPTURE(size);
    CHECK(folder.place_of(name) == 0);
  }
  std::string other = good;
  other[other.find("boot ") + 5] ^= 1;
  folder.write(other);
  CHECK(folder.place_of(name) == 0);
  folder.write(good);
  REQUIRE(folder.place_of(name) == 2);
  std::filesystem::rename(folder.path, folder.path + ".real");
  std::filesystem::create_symlink(folder.path + ".real", folder.path);
  CHECK(folder.place_of(name) == 0);
}

TEST_CASE("where nothing can be written it goes on, and begins anew") {
  const CourseName name = name_of(0, 0, kPlaces);
  CourseRecord record("/nonexistent/folder/course");
  record.note(name, 1);
  record.note(name, 2);
  CHECK(record.place_of(name) == 0);
}

}  // namespace
}  // namespace gvom::test
