// The Foxglove server and its clients: well-behaved, slow, and hostile ones.
#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "services/bridge/foxglove_server.hpp"
#include "tests/bridge/stranger.hpp"
#include "tests/bridge/ws_client.hpp"
#include "tests/tools/temporary_folder.hpp"

namespace {

using namespace gvom;
using bridge::FoxgloveServer;
using bridge::TopicId;
using nlohmann::json;
using test::Stranger;
using test::upgrade;
using test::WsClient;

constexpr std::uint32_t kCostmap = 1, kLayers = 3;  // channels

std::unique_ptr<FoxgloveServer> started(bridge::FoxgloveOptions options = {}) {
  options.vehicle = "truck";
  options.port = options.port == 8765 ? std::uint16_t{0} : options.port;
  auto server = FoxgloveServer::start(std::move(options));
  REQUIRE(server);
  REQUIRE(test::eventually([&] { return (*server)->port() != 0 || !(*server)->problem().empty(); }));
  return std::move(*server);
}

ros::Blob blob(std::size_t size, std::uint8_t value) {
  return std::make_shared<std::vector<std::uint8_t>>(size, value);
}

bool subscribed(const FoxgloveServer& server, TopicId id) {
  return test::eventually([&] { return server.wants(bridge::topic(id)); });
}

TEST_CASE("a client is told who we are and what there is, and gets what it subscribes to") {
  const auto server = started();
  CHECK(!server->wants(bridge::topic(TopicId::costmap)));
  const auto client = WsClient::connect(server->port());
  REQUIRE(client);
  const auto hello = client->read(), channels = client->read();
  REQUIRE(hello);
  REQUIRE(channels);
  CHECK(json::parse(hello->as_text())["op"] == "serverInfo");
  CHECK(json::parse(hello->as_text())["name"] == "truck");
  const json channel = json::parse(channels->as_text())["channels"][kCostmap - 1];
  CHECK(channel["topic"] == "/gvom/costmap");
  CHECK(channel["schemaName"] == "nav_msgs/msg/OccupancyGrid");
  CHECK(channel["schemaEncoding"] == "ros2msg");
  CHECK_THAT(channel["schema"].get<std::string>(), Catch::Contains("MSG: nav_msgs/MapMetaData"));

  REQUIRE(client->subscribe(77, kCostmap));
  REQUIRE(subscribed(*server, TopicId::costmap));
  CHECK(!server->wants(bridge::topic(TopicId::layers)));
  server->offer(bridge::topic(TopicId::costmap), 0x0102030405060708, blob(3, 9));
  const auto data = client->read();
  REQUIRE(data);
  CHECK(data->bytes == std::vector<std::uint8_t>{1, 77, 0, 0, 0, 8, 7, 6, 5, 4, 3, 2, 1, 9, 9, 9});
  CHECK(test::eventually([&] { return server->counters().sent == 1; }));
  CHECK(server->counters().clients == 1);

  REQUIRE(client->send(R"({"op":"unsubscribe","subscriptionIds":[77]})"));
  CHECK(test::eventually([&] { return !server->wants(bridge::topic(TopicId::costmap)); }));
}

const std::string kSdk = "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n";

TEST_CASE("both subprotocols are spoken; without one, from a foreign page, or as the 17th, nobody gets in") {
  const auto server = started();
  const auto sdk = WsClient::connect(server->port(), "foxglove.sdk.v1, foxglove.websocket.v1");
  REQUIRE(sdk);
  CHECK(sdk->subprotocol() == "foxglove.sdk.v1");
  const auto answer = [&](const std::string& headers) {
    return test::raw_exchange(server->port(), upgrade(headers));
  };
  CHECK_THAT(answer(""), Catch::StartsWith("HTTP/1.1 400"));
  CHECK_THAT(answer(kSdk + "Origin: http://evil.example\r\n"), Catch::StartsWith("HTTP/1.1 403"));
  std::vector<std::unique_ptr<WsClient>> clients;
  for (std::size_t i = 1; i < bridge::kMostClients; ++i) {
    clients.push_back(WsClient::connect(server->port()));
    REQUIRE(clients.back());
  }
  CHECK_THAT(answer(kSdk + "Origin: http://127.0.0.1\r\n"), Catch::StartsWith("HTTP/1.1 503"));
  CHECK(test::eventually([&] { return server->counters().refused == 3; }));
}

TEST_CASE("a slow client sees the newest: what waits is replaced, not queued") {
  constexpr std::size_t kSize = 4 << 20;  // more than the sockets hold
  const auto server = started();
  const auto slow = WsClient::connect(server->port());
  REQUIRE(slow);
  REQUIRE(slow->subscribe(1, kLayers));
  REQUIRE(subscribed(*server, TopicId::layers));
  std::vector<std::weak_ptr<const std::vector<std::uint8_t>>> offered;
  for (std::uint8_t i = 0; i < 50; ++i) {
    const ros::Blob message = blob(kSize, i);
    offered.emplace_back(message);
    server->offer(bridge::topic(TopicId::layers), i, message);
    // The one that is sent, the one that waits there, and the one that waits here.
    std::size_t alive = 0;
    for (const auto& one : offered) alive += one.expired() ? 0 : 1;
    REQUIRE(alive <= 1 + 3);
  }
  REQUIRE(test::eventually([&] { return server->counters().replaced >= 48; }));
  std::size_t got = 0;
  for (std::uint8_t newest = 0; newest != 49; ++got) {
    const auto message = slow->read_data();
    REQUIRE(message);
    CHECK(message->bytes.size() == kSize + 13);
    newest = message->bytes.back();
  }
  CHECK(got <= 2);
  CHECK(test::eventually([&] { return server->counters().sent + server->counters().replaced == 50; }));
  CHECK(server->counters().sent == got);
}

TEST_CASE("who sends what no client sends is closed and counted; the others stay") {
  const auto server = started();
  const auto good = WsClient::connect(server->port());
  REQUIRE(good);
  REQUIRE(good->subscribe(1, kCostmap));
  std::uint64_t refused = 0;
  const auto is_closed_after = [&](auto&& act) {
    const auto bad = WsClient::connect(server->port());
    REQUIRE(bad);
    act(*bad);
    ++refused;
    CHECK(test::eventually([&] { return server->counters().refused == refused; }));
    CHECK(!bad->read_data());
  };
  is_closed_after([](WsClient& c) { c.send("garbage"); });
  is_closed_after([](WsClient& c) { c.send("[]"); });
  is_closed_after([](WsClient& c) { c.send(R"({"op":7})"); });
  is_closed_after([](WsClient& c) { c.send(std::string(60'000, '[')); });
  is_closed_after([](WsClient& c) { c.send(std::string(70'000, ' ')); });
  is_closed_after([](WsClient& c) { c.send_binary("\x01"); });
  is_closed_after([](WsClient& c) { c.subscribe(1, 999); });
  is_closed_after(
      [](WsClient& c) { c.send(R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})"); });
  is_closed_after([](WsClient& c) { c.subscribe(1, 1), c.subscribe(1, 2); });
  REQUIRE(good->send(R"({"op":"getParameters","parameterNames":[]})"));  // not ours, but of the protocol
  REQUIRE(subscribed(*server, TopicId::costmap));
  server->offer(bridge::topic(TopicId::costmap), 5, blob(1, 1));
  CHECK(good->read_data());
  CHECK(test::eventually([&] { return server->counters().clients == 1; }));
}

TEST_CASE("a frame that announces 100 MB is refused before it comes") {
  const auto server = started();
  const std::string head("\x81\xff\x00\x00\x00\x00\x06\x40\x00\x00mask", 14);
  const std::string answer = test::raw_exchange(server->port(), upgrade(kSdk), head + "and some bytes");
  CHECK_THAT(answer, Catch::StartsWith("HTTP/1.1 101"));
  CHECK(test::eventually([&] { return server->counters().refused == 1; }));
}

TEST_CASE("who does not ask within the time there is gets closed; counted if it had begun") {
  bridge::FoxgloveOptions options;
  options.patience = std::chrono::seconds(3);
  const auto server = started(options);
  const Stranger silent(server->port()), slow(server->port());
  REQUIRE(slow.send("GET / HT"));
  const auto drips_until_closed = [&] {
    slow.send("T");
    return slow.is_closed_now();
  };
  CHECK(test::eventually(drips_until_closed));  // each byte does not buy it more time
  CHECK(silent.is_closed());
  CHECK(test::eventually([&] { return server->counters().refused == 1; }));
}

TEST_CASE("who speaks before the handshake is answered is told so, not misunderstood") {
  const auto server = started();
  const std::string ping("\x89\x80mask", 6);
  const std::string answer = test::raw_exchange(server->port(), upgrade(kSdk) + ping);
  CHECK_THAT(answer, Catch::StartsWith("HTTP/1.1 400") && Catch::Contains("before the answer"));
  CHECK(server->counters().refused == 1);
}

TEST_CASE("what is no HTTP, or has an endless head, is closed and counted") {
  const auto server = started();
  test::raw_exchange(server->port(), "\x16\x03\x01\x02 garbage\r\n\r\n");
  test::raw_exchange(server->port(), "GET / HTTP/1.1\r\nX: " + std::string(20'000, 'x') + "\r\n\r\n");
  CHECK(test::eventually([&] { return server->counters().refused == 2; }));
}

std::string get(const FoxgloveServer& server, const std::string& target) {
  return test::raw_exchange(server.port(), "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
}

TEST_CASE("browsers get the page's files and nothing beside them") {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() + "/page/assets");
  std::ofstream(folder.path() + "/secret.txt") << "secret";
  std::ofstream(folder.path() + "/page/index.html") << "<p>hello";
  std::ofstream(folder.path() + "/page/assets/a-1.js") << "let a";
  bridge::FoxgloveOptions options;
  options.page = folder.path() + "/page";
  const auto server = started(options);
  CHECK_THAT(get(*server, "/"), Catch::StartsWith("HTTP/1.1 200") && Catch::EndsWith("<p>hello") &&
                                    Catch::Contains("text/html"));
  CHECK_THAT(get(*server, "/assets/a-1.js?v=2"),
             Catch::EndsWith("let a") && Catch::Contains("text/javascript"));
  for (const char* target : {"/../secret.txt", "/assets/../../secret.txt", "/%2e%2e/secret.txt", "/assets",
                             "//etc/passwd", "/nothing", "/..\\secret.txt", "secret.txt"}) {
    const std::string answer = get(*server, target);
    INFO(target);
    CHECK_THAT(answer, !Catch::Contains("secret\n") && !Catch::EndsWith("secret"));
    CHECK_THAT(answer, Catch::StartsWith("HTTP/1.1 40"));
  }
  CHECK_THAT(test::raw_exchange(server->port(), "POST / HTTP/1.1\r\nHost: x\r\n\r\n"),
             Catch::StartsWith("HTTP/1.1 405"));
}

TEST_CASE("without a page a browser is told where Foxglove connects") {
  CHECK_THAT(get(*started(), "/"), Catch::StartsWith("HTTP/1.1 404") && Catch::Contains("ws://localhost"));
}

TEST_CASE("a port that is taken is a problem in words, and taken when it is free") {
  auto first = started();
  bridge::FoxgloveOptions options;
  options.port = first->port();
  options.retry = std::chrono::milliseconds(20);
  const auto second = started(options);
  CHECK_THAT(second->problem(),
             Catch::Contains("127.0.0.1:" + std::to_string(options.port)) && Catch::Contains("in use"));
  CHECK(second->port() == 0);
  second->offer(bridge::topic(TopicId::costmap), 1, blob(1, 1));
  first.reset();
  CHECK(test::eventually([&] { return second->port() == options.port; }));
  CHECK(second->problem().empty());
  CHECK(WsClient::connect(options.port));
}

TEST_CASE("an address that is none is an error") {
  bridge::FoxgloveOptions options;
  options.address = "my-truck";
  CHECK(FoxgloveServer::start(options).error() == "'my-truck' is no IP address");
}

}  // namespace
