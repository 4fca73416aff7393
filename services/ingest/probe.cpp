#include "services/ingest/probe.hpp"

#include <chrono>
#include <cstdint>
#include <map>

namespace gvom::ingest {
namespace {

std::string text_of(const std::map<std::size_t, std::uint64_t>& sizes) {
  std::string text;
  for (const auto& [size, count] : sizes) {
    if (text.size() > 200) break;
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " of " + std::to_string(size) + " bytes";
  }
  return text.empty() ? "none" : text;
}

}  // namespace

tl::expected<Strangers, std::string> look_for_sensor(PacketSource& packets, Decoder& decoder) {
  Strangers strangers;
  std::map<std::size_t, std::uint64_t> sizes;
  for (;;) {
    Packet packet;
    const auto event = packets.next(packet, std::chrono::milliseconds(0));
    if (!event) return tl::unexpected(event.error());
    if (*event == PacketEvent::end) break;
    if (decoder.recognises(packet) && decoder.is_of_this_sensor(packet)) {
      decoder.expect_like(packet);
      strangers.found = true;
      return strangers;
    }
    ++sizes[packet.size];
    KindText kind{};
    decoder.name_other(packet, kind);
    if (strangers.of_another.empty() && kind[0] != '\0')
      strangers.of_another = std::string(kind.data()) + "); " + decoder.override_advice(packet);
  }
  strangers.sizes = text_of(sizes);
  return strangers;
}

std::string no_such_packets(const Strangers& strangers, const Decoder& decoder, const std::string& where,
                            const std::string& which) {
  if (!strangers.of_another.empty())
    return where + ": the packets are of another sensor (" + strangers.of_another;
  return where + ": no packet is of the sensor that is asked for (" + decoder.expects() + "); " + which +
         ": " + strangers.sizes;
}

}  // namespace gvom::ingest
