// A drive's log is whole when the drive is cut, and says when it could not be written.
#include <catch2/catch.hpp>

#include <fstream>
#include <iterator>

#include "services/planner/planner.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/drive/cli/log_file.hpp"

using namespace gvom;
using namespace gvom::driving;

namespace {

void see_a_plan(const Onlooker& looks) {
  planner::Plan plan;
  plan.why = "stops: the layers are 0.6 s old";
  const LayerArrays layers{};
  const Grid grid;
  looks({layers, grid, 0, 0, {}}, plan);
}

}  // namespace

TEST_CASE("a line of a drive's log is in the file at once") {
  const test::TemporaryFolder folder;
  DriveFile file(folder.path() + "/a/b", "world", 3);
  see_a_plan(file.onlooker());
  std::ifstream log(folder.path() + "/a/b/world-3.csv");
  const std::string text{std::istreambuf_iterator<char>(log), {}};
  CHECK_THAT(text, Catch::EndsWith(",\"stops: the layers are 0.6 s old\"\n"));
  CHECK(file.close());
}

TEST_CASE("a log that cannot be written is told, and none that was not wanted") {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() + "/taken") << "a file where a folder should be";
  DriveFile file(folder.path() + "/taken", "world", 3);
  see_a_plan(file.onlooker());
  const auto closed = file.close();
  REQUIRE_FALSE(closed);
  CHECK(closed.error() == folder.path() + "/taken/world-3.csv: cannot be written");
  DriveFile none("", "world", 3);
  CHECK_FALSE(none.onlooker());
  CHECK(none.close());
}
