// Who may connect, and what a request names: no sockets.
#include <catch2/catch.hpp>

#include "services/bridge/foxglove_protocol.hpp"
#include "services/bridge/outbox.hpp"
#include "services/bridge/settings.hpp"
#include "services/bridge/web.hpp"

namespace {

using namespace gvom;
using bridge::is_allowed_origin;
using bridge::Outbox;
using bridge::TopicId;

TEST_CASE("our own page may connect where nobody else's name server says what our name means") {
  CHECK(is_allowed_origin("", "anything", {}));
  CHECK(is_allowed_origin("http://10.0.0.7:8765", "10.0.0.7:8765", {}));
  CHECK(is_allowed_origin("http://[::1]:8765", "[::1]:8765", {}));
  CHECK(is_allowed_origin("http://localhost:8765", "localhost:8765", {}));
  CHECK(is_allowed_origin("http://truck:8765", "truck:8765", {}));
  CHECK(is_allowed_origin("http://truck.local:8765", "truck.local:8765", {}));
  CHECK(!is_allowed_origin("http://evil.example:8765", "evil.example:8765", {}));
  CHECK(!is_allowed_origin("http://localhost:8766", "localhost:8765", {}));
  CHECK(!is_allowed_origin("null", "localhost:8765", {}));
  CHECK(!is_allowed_origin("http://", "", {}));
  CHECK(is_allowed_origin("https://app.foxglove.dev", "localhost:8765", {"https://app.foxglove.dev"}));
}

TEST_CASE("lists in keys are parts between commas") {
  using List = std::vector<std::string>;
  CHECK(bridge::split_list("a, b\t,,c d ,") == List{"a", "b", "c d"});
  CHECK(bridge::split_list("") == List{});
  CHECK(bridge::split_list(" , ") == List{});
}

TEST_CASE("a misspelt layer or topic is named, with those that there are") {
  services::VehicleConfig config;
  CHECK(bridge::message_settings(config));
  CHECK(bridge::recorded_topics(config)->size() == 7);
  config.bridge.grid_map_layers = "height,hight";
  CHECK_THAT(
      bridge::message_settings(config).error().text(),
      Catch::Contains("bridge.grid_map_layers: there is no 'hight'") && Catch::Contains("inferred_height"));
  config.bridge.grid_map_layers = "cost, cost";
  CHECK(bridge::message_settings(config)->grid_map_layers == std::vector<LayerId>{LayerId::cost});
  config.bridge.odom_frame = "/odom";
  CHECK_THAT(bridge::message_settings(config).error().text(), Catch::Contains("bridge.odom_frame"));
  config.bridge.mcap.topics = "/gvom/costmap,/costmap";
  CHECK_THAT(bridge::recorded_topics(config).error().text(), Catch::Contains("'/costmap'"));
}

TEST_CASE("no subscription starves another, and a newer message takes the older's place") {
  Outbox outbox;
  const auto message = std::make_shared<std::vector<std::uint8_t>>();
  REQUIRE(outbox.subscribe({1, TopicId::costmap}));
  REQUIRE(outbox.subscribe({2, TopicId::layers}));
  REQUIRE(outbox.subscribe({3, TopicId::layers}));
  CHECK(!outbox.subscribe({3, TopicId::tf}));
  CHECK(outbox.put(TopicId::layers, 10, message) == 0);
  CHECK(outbox.put(TopicId::costmap, 11, message) == 0);
  CHECK(outbox.put(TopicId::layers, 12, message) == 2);
  std::vector<std::uint32_t> order;
  while (const auto next = outbox.take()) {
    order.push_back(next->subscription);
    if (order.size() == 1) outbox.put(TopicId::costmap, 13, message);
    if (order.size() > 1 && order.back() != 1) CHECK(next->stamp_ns == 12);
  }
  CHECK(order == std::vector<std::uint32_t>{1, 2, 3, 1});
  CHECK(outbox.unsubscribe(2) == TopicId::layers);
  CHECK(!outbox.unsubscribe(2));
  for (std::uint32_t id = 10; outbox.topics().size() < Outbox::kMostSubscriptions; ++id)
    REQUIRE(outbox.subscribe({id, TopicId::tf}));
  CHECK(!outbox.subscribe({9999, TopicId::tf}));
}

}  // namespace
