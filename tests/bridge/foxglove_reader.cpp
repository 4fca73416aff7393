// foxglove_reader PORT: subscribes to all that gvom-bridge advertises there, and reads as fast as it comes,
// until SIGTERM. Then one line for each topic.
#include <signal.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <thread>

#include <nlohmann/json.hpp>

#include "tests/bridge/ws_client.hpp"

namespace {

using gvom::test::WsClient;

struct Count {
  std::string topic;
  unsigned long long messages = 0;
  unsigned long long bytes = 0;
};

volatile sig_atomic_t stopped = 0;

std::unique_ptr<WsClient> connect(std::uint16_t port) {
  std::unique_ptr<WsClient> client;
  gvom::test::eventually([&] { return (client = WsClient::connect(port)) != nullptr; });
  return client;
}

/// Each channel is a subscription of the same number.
void subscribe(WsClient& client, const std::string& text, std::map<std::uint32_t, Count>& counts) {
  const auto said = nlohmann::json::parse(text, nullptr, false);
  if (said.value("op", "") != "advertise") return;
  for (const auto& channel : said["channels"]) {
    const auto id = channel["id"].get<std::uint32_t>();
    counts[id].topic = channel["topic"].get<std::string>();
    client.subscribe(id, id);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 64;
  struct sigaction action {};
  action.sa_handler = [](int) { stopped = 1; };
  ::sigaction(SIGTERM, &action, nullptr);
  const auto client = connect(static_cast<std::uint16_t>(std::atoi(argv[1])));
  if (client == nullptr) return 69;
  std::map<std::uint32_t, Count> counts;
  while (!stopped) {
    const auto message = client->read();
    if (!message) break;
    if (message->text) {
      subscribe(*client, message->as_text(), counts);
      continue;
    }
    std::uint32_t id = 0;
    std::memcpy(&id, message->bytes.data() + 1, sizeof id);
    ++counts[id].messages;
    counts[id].bytes += message->bytes.size();
  }
  for (const auto& [id, count] : counts)
    std::printf("%s received %llu bytes %llu\n", count.topic.c_str(), count.messages, count.bytes);
  return stopped ? 0 : 69;
}
