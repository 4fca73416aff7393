#include <catch2/catch.hpp>

#include "services/common/dds/network_watch.hpp"

using namespace gvom::dds;

namespace {

const InterfaceAddress kLoopback{"lo", 1, "127.0.0.1", true};
const InterfaceAddress kWired{"eth0", 2, "10.0.0.7", false};
const InterfaceAddress kWiredElsewhere{"eth0", 2, "10.0.0.8", false};
const InterfaceAddress kWiredAnew{"eth0", 5, "10.0.0.7", false};
const InterfaceAddress kWireless{"wlan0", 3, "192.168.1.5", false};

/// Who joined by `interface` when there was `before`, and now there is `now`.
std::string loss(const std::string& interface, const InterfaceAddresses& before,
                 const InterfaceAddresses& now) {
  return loss_between(interface, usable(before, interface), now);
}

}  // namespace

TEST_CASE("the loopback is a network for who names it, and where there is no other") {
  CHECK(usable({kLoopback}, "").size() == 1);
  CHECK(usable({}, "").empty());
  CHECK(usable({kLoopback}, "", false).empty());  // a configuration file may say otherwise
  CHECK(usable({kLoopback, kWired}, "").size() == 1);
  CHECK(usable({kLoopback, kWired}, "lo").size() == 1);
  CHECK(usable({kLoopback, kWired}, "127.0.0.1").size() == 1);
}

TEST_CASE("a named interface is lost when it is down, removed, or elsewhere") {
  for (const char* interface : {"eth0", "10.0.0.7"}) {
    INFO(interface);
    CHECK(loss(interface, {kLoopback, kWired}, {kLoopback, kWired, kWireless}).empty());
    CHECK(loss(interface, {kLoopback, kWired}, {kLoopback, kWireless}) ==
          "the network that was joined is gone: 10.0.0.7 of eth0");
    CHECK_FALSE(loss(interface, {kLoopback, kWired}, {kLoopback, kWiredElsewhere}).empty());
    CHECK_FALSE(loss(interface, {kLoopback, kWired}, {kLoopback, kWiredAnew}).empty());
  }
}

TEST_CASE("without a name the network is lost with its last interface") {
  CHECK(loss("", {kLoopback, kWired, kWireless}, {kLoopback, kWireless}).empty());
  CHECK_FALSE(loss("", {kLoopback, kWired, kWireless}, {kLoopback, kWiredElsewhere}).empty());
  CHECK(loss("", {}, {kWired}).empty());
}

TEST_CASE("who joined the loopback for want of a network joins anew when there is one") {
  CHECK(loss("", {kLoopback}, {kLoopback}).empty());
  CHECK(loss("", {kLoopback}, {kLoopback, kWired}) ==
        "only the loopback was joined, and there is a network now: 10.0.0.7 of eth0");
  CHECK(loss("", {kLoopback}, {}) == "the network that was joined is gone: 127.0.0.1 of lo");
  CHECK(loss("lo", {kLoopback}, {kLoopback, kWired}).empty());
}

TEST_CASE("this machine's loopback is found while it is up") {
  const auto found = usable(interface_addresses(), "127.0.0.1");
  for (const InterfaceAddress& one : found) CHECK(one.loopback);
  CHECK(NetworkWatch("").loss().empty());
}
