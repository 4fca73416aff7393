#include <catch2/catch.hpp>

#include <string>

#include "ipc/runtime.hpp"
#include "ipc/text.hpp"
#include "ipc/topic.hpp"

using namespace gvom;
using namespace gvom::ipc;

TEST_CASE("names that would abort in iceoryx are refused before it sees them") {
  for (const std::string name :
       {"", "/gvom", "gvom fusion", "gvom/fusion", ".gvom", "gv\xc3\xb6m", "roudi"}) {
    INFO("name '" << name << "'");
    const auto checked = check_runtime_name(name);
    REQUIRE(!checked);
    CHECK(checked.error().kind == ErrorKind::bad_name);
  }
  CHECK(!check_runtime_name(std::string(64, 'x')));
  CHECK(check_runtime_name(std::string(63, 'x')));
  CHECK(check_runtime_name("gvom-ingest-top_2.1"));
}

TEST_CASE("lidar names fit their field") {
  CHECK(buffer_map_topic("front_left_2"));
  CHECK(buffer_map_topic(std::string(31, 'a')));
  CHECK(!buffer_map_topic(std::string(32, 'a')));
  for (const std::string name : {"", "Front", "front left", "front/left"}) CHECK(!buffer_map_topic(name));
}

TEST_CASE("text fields are cut, terminated and zeroed") {
  char field[4] = {'x', 'x', 'x', 'x'};
  set_text(field, "ab");
  CHECK(std::string(field, 4) == std::string("ab\0\0", 4));
  set_text(field, "abcdef");
  CHECK(text_of(field) == "abc");
  field[3] = 'd';  // another process may leave out the end
  CHECK(text_of(field) == "abcd");
}
