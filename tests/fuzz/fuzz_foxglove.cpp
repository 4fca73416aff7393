// What a client of the bridge says, after HTTP and websocket have been taken off. First byte: which part of
// it.
#include <filesystem>
#include <fstream>

#include "services/bridge/foxglove_protocol.hpp"
#include "services/bridge/outbox.hpp"
#include "services/bridge/web.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::fuzz;

namespace {

constexpr const char* kSecret = "what lies beside the page";

/// The page's folder, with two files, and a file beside it.
std::string make_page(const std::string& folder) {
  std::filesystem::create_directories(folder + "/page/assets");
  std::ofstream(folder + "/secret") << kSecret;
  std::ofstream(folder + "/page/index.html") << "<p>";
  std::ofstream(folder + "/page/assets/a.js") << "let a";
  return folder + "/page";
}

void try_request(const std::string& text) {
  const auto request = bridge::read_request(text);
  require(request || !request.error().empty(), "an error says what it is");
  if (!request) return;
  bridge::Outbox outbox;
  std::size_t subscribed = 0;
  for (const bridge::Subscription& one : request->subscribe) {
    require(static_cast<std::size_t>(one.topic) < bridge::kTopics.size(), "a subscription is of a topic");
    subscribed += outbox.subscribe(one) ? 1 : 0;
  }
  require(outbox.topics().size() == subscribed, "each subscription once");
  require(subscribed <= bridge::Outbox::kMostSubscriptions, "no more than there may be");
  for (const bridge::Topic& topic : bridge::kTopics)
    outbox.put(topic.id, 1, std::make_shared<std::vector<std::uint8_t>>(1));
  std::size_t taken = 0;
  while (outbox.take()) ++taken;
  require(taken == subscribed, "each subscription gets its message");
  for (const std::uint32_t id : request->unsubscribe) subscribed -= outbox.unsubscribe(id) ? 1 : 0;
  require(outbox.topics().size() == subscribed, "what is unsubscribed is gone");
}

void try_origin(const std::string& text) {
  const std::size_t split = std::min(text.find('\n'), text.size());
  const std::string origin = text.substr(0, split), host = text.substr(std::min(split + 1, text.size()));
  const bool allowed = bridge::is_allowed_origin(origin, host, {"https://known.example"});
  const bool may = origin.empty() || origin == "https://known.example" || origin == "http://" + host;
  require(may || !allowed, "a foreign page does not get in");
}

void try_file(const std::string& target) {
  static const test::TemporaryFolder folder;
  static const std::string page = make_page(folder.path());
  const auto file = bridge::web_file(page, target);
  require(!file || file->text == "<p>" || file->text == "let a", "only the page's files are handed out");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  const std::uint8_t part = input.byte();
  const std::string text = text_of(input.rest());
  switch (part) {
    case 0:
      try_request(text);
      break;
    case 1:
      try_origin(text);
      break;
    case 2:
      try_file(text);
      break;
    case 3:
      if (const auto chosen = bridge::chosen_subprotocol(text))
        require(text.find(*chosen) != text.npos, "what is chosen was offered");
      break;
    default:
      break;
  }
  return 0;
}
