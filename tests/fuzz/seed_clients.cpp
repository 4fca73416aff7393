// What clients of the bridge say.
#include "tests/fuzz/seeds.hpp"

namespace gvom::fuzz {
namespace {

/// A masked frame of a client; the mask is zero, so that its text can be read.
std::string frame(char opcode, const std::string& text) {
  std::string head{static_cast<char>(0x80 | opcode)};
  if (text.size() < 126) {
    head += static_cast<char>(0x80 | text.size());
  } else {
    head += static_cast<char>(0x80 | 126);
    head += static_cast<char>(text.size() >> 8);
    head += static_cast<char>(text.size());
  }
  return head + std::string(4, '\0') + text;
}

}  // namespace

void add_clients(Seeds& seeds) {
  const std::string subscribe =
      R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":1},{"id":8,"channelId":10}]})";
  const std::string unsubscribe = R"({"op":"unsubscribe","subscriptionIds":[7]})";
  for (const std::string& text : {subscribe, unsubscribe, std::string(R"({"op":"getParameters","id":"x"})")})
    seeds.add("foxglove", std::string(1, '\0') + text);
  for (const char* origin : {"http://10.0.0.1:8765\n10.0.0.1:8765", "http://[::1]:8765\n[::1]:8765",
                             "http://truck.local\ntruck.local", "https://known.example\nx"})
    seeds.add("foxglove", "\x01" + std::string(origin));
  for (const char* target : {"/", "/assets/a.js?v=1", "/../secret"})
    seeds.add("foxglove", "\x02" + std::string(target));
  seeds.add("foxglove", std::string("\x03") + "foxglove.sdk.v1, foxglove.websocket.v1");

  seeds.add("http",
            std::string(1, '\0') + "GET /index.html HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  seeds.add("http",
            std::string(1, '\0') + "POST / HTTP/1.1\r\nContent-Length: 3\r\nExpect: 100-continue\r\n\r\nabc");
  seeds.add("http", std::string(1, '\0') +
                        "GET / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n");
  seeds.add("http",
            "\x01" + frame(1, subscribe) + frame(1, unsubscribe) + frame(8, std::string("\x03\xe8", 2)));
  seeds.add("http", "\x01" + frame(9, "ping") + frame(10, "pong") + frame(2, "binary"));
  std::string parts = frame(1, subscribe.substr(0, 30)) + frame(0, subscribe.substr(30));
  parts[0] = 1;  // not the last of its message
  seeds.add("http", "\x01" + parts);
  seeds.add("http", std::string("\x01\x81\xff\0\0\0\0\x06\x40\0\0mask", 15));  // announces 100 MB
}

}  // namespace gvom::fuzz
