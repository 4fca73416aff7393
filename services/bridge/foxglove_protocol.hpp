// What is said on Foxglove's websocket, as text and bytes. Subprotocols foxglove.websocket.v1 and
// foxglove.sdk.v1 say the same.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "services/bridge/topic.hpp"

namespace gvom::bridge {

/// The first that we speak of those that a client offers in Sec-WebSocket-Protocol; nothing if it offers
/// none.
std::optional<std::string> chosen_subprotocol(std::string_view offered);

/// The first message: who we are. `session` differs after each start.
std::string server_info(const std::string& name, const std::string& session);

/// The second: all of kTopics, with their schemas. A channel's id is its place there, from 1.
std::string advertisement();

struct Subscription {
  std::uint32_t id;
  TopicId topic;
};

/// What a client asks for.
struct ClientRequest {
  std::vector<Subscription> subscribe;
  std::vector<std::uint32_t> unsubscribe;  ///< Ids of subscriptions.
};

/// Other operations of the protocol ask for nothing that we have: an empty request. The error says what is
/// wrong with a text that is no operation at all.
tl::expected<ClientRequest, std::string> read_request(std::string_view text);

/// What goes before a message's own bytes: 1, the subscription, the time.
std::array<std::uint8_t, 13> data_head(std::uint32_t subscription, std::int64_t stamp_ns);

}  // namespace gvom::bridge
