#include "services/bridge/foxglove_protocol.hpp"

#include <algorithm>
#include <cstring>

#include <nlohmann/json.hpp>

#include "services/bridge/settings.hpp"
#include "services/common/ros/schemas.hpp"

namespace gvom::bridge {
namespace {

using nlohmann::json;

constexpr std::string_view kSubprotocols[] = {"foxglove.websocket.v1", "foxglove.sdk.v1"};

json channel_of(const Topic& topic) {
  json channel = {{"id", static_cast<std::uint32_t>(topic.id) + 1}, {"topic", topic.name}};
  if (topic.type == nullptr) {
    channel.update({{"encoding", "json"}, {"schemaName", ""}, {"schema", ""}});
  } else {
    channel.update({{"encoding", "cdr"},
                    {"schemaName", topic.type},
                    {"schema", ros::schema_of(topic.type).value_or("")},
                    {"schemaEncoding", "ros2msg"}});
  }
  return channel;
}

std::optional<std::uint32_t> id_in(const json& value) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > UINT32_MAX) return std::nullopt;
  return value.get<std::uint32_t>();
}

std::optional<std::uint32_t> id_in(const json& object, const char* key) {
  if (!object.is_object()) return std::nullopt;
  const auto found = object.find(key);
  return found == object.end() ? std::nullopt : id_in(*found);
}

tl::expected<std::vector<Subscription>, std::string> subscriptions_in(const json& list) {
  std::vector<Subscription> subscriptions;
  for (const json& entry : list) {
    const auto id = id_in(entry, "id"), channel = id_in(entry, "channelId");
    if (!id || !channel) return tl::unexpected(std::string("a subscription without id or channelId"));
    if (*channel == 0 || *channel > kTopics.size())
      return tl::unexpected("there is no channel " + std::to_string(*channel));
    subscriptions.push_back({*id, kTopics[*channel - 1].id});
  }
  return subscriptions;
}

/// The list of that name; an empty one if there is none.
json list_in(const json& message, const char* key) {
  const auto found = message.find(key);
  return found != message.end() && found->is_array() ? *found : json::array();
}

}  // namespace

std::optional<std::string> chosen_subprotocol(std::string_view offered) {
  const std::vector<std::string> words = split_list(std::string(offered));
  for (const std::string& word : words)
    if (std::find(std::begin(kSubprotocols), std::end(kSubprotocols), word) != std::end(kSubprotocols))
      return word;
  return std::nullopt;
}

std::string server_info(const std::string& name, const std::string& session) {
  return json{{"op", "serverInfo"},
              {"name", name},
              {"capabilities", json::array()},
              {"supportedEncodings", json::array()},
              {"metadata", json::object()},
              {"sessionId", session}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string advertisement() {
  json channels = json::array();
  for (const Topic& topic : kTopics) channels.push_back(channel_of(topic));
  return json{{"op", "advertise"}, {"channels", channels}}.dump();
}

tl::expected<ClientRequest, std::string> read_request(std::string_view text) {
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) return tl::unexpected(std::string("not a JSON object"));
  const auto op = message.find("op");
  if (op == message.end() || !op->is_string()) return tl::unexpected(std::string("no operation (op)"));
  ClientRequest request;
  if (*op == "subscribe") {
    auto subscriptions = subscriptions_in(list_in(message, "subscriptions"));
    if (!subscriptions) return tl::unexpected(subscriptions.error());
    request.subscribe = std::move(*subscriptions);
  }
  if (*op == "unsubscribe") {
    for (const json& entry : list_in(message, "subscriptionIds")) {
      const auto id = id_in(entry);
      if (!id) return tl::unexpected(std::string("a subscription's id that is none"));
      request.unsubscribe.push_back(*id);
    }
  }
  return request;
}

std::array<std::uint8_t, 13> data_head(std::uint32_t subscription, std::int64_t stamp_ns) {
  std::array<std::uint8_t, 13> head = {1};
  const auto time_ns = static_cast<std::uint64_t>(std::max<std::int64_t>(stamp_ns, 0));
  std::memcpy(head.data() + 1, &subscription, sizeof subscription);
  std::memcpy(head.data() + 5, &time_ns, sizeof time_ns);
  return head;
}

}  // namespace gvom::bridge
