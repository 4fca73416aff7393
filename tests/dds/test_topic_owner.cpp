#include <catch2/catch.hpp>

#include "services/common/dds/topic_owner.hpp"

using namespace gvom::dds;

TEST_CASE("a topic is another publisher's when the first has been silent for a second") {
  TopicOwner owner;
  CHECK(owner.is_owner(1, 0));
  CHECK_FALSE(owner.is_owner(2, 900'000'000));
  CHECK(owner.is_owner(1, 1'000'000'000));
  CHECK_FALSE(owner.is_owner(2, 2'000'000'000));
  CHECK(owner.is_owner(2, 2'000'000'001));
  CHECK_FALSE(owner.is_owner(1, 2'000'000'002));
}
