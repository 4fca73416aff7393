// What gvomctl reads of the system.
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "services/ingest/udp_ports.hpp"
#include "tools/ctl/check.hpp"
#include "tools/ctl/units.hpp"
#include "tools/ctl/vehicle.hpp"

using namespace gvom;

TEST_CASE("a process's unit is the instance of its lidar") {
  CHECK(ctl::unit_of("gvom-fusion") == "gvom-fusion.service");
  CHECK(ctl::unit_of("gvom-ingest-front") == "gvom-ingest@front.service");
}

TEST_CASE("gvom-odometry is expected only where it has something to replay") {
  services::VehicleConfig config;
  config.name = "v";
  config.lidars.resize(2);
  config.lidars[0].name = "front";
  config.lidars[1].name = "rear";
  CHECK(ctl::expected_of(config).processes ==
        std::vector<std::string>{"gvom-fusion", "gvom-ingest-front", "gvom-ingest-rear"});
  config.odometry.source = "tum:odometry.tum";
  CHECK(ctl::expected_of(config).processes.front() == "gvom-odometry");
}

TEST_CASE("sockets on a port are found by their local address alone") {
  const std::string table =
      "   sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode\n"
      "  186: 00000000:1D4E 00000000:0000 07 00000000:00000000 00:00000000 00000000   998        0 4711 2 0 "
      "0\n"
      "  187: 0100007F:1D4F 0100007F:1D4E 01 00000000:00000000 00:00000000 00000000   998        0 4712 2 0 "
      "0\n";
  CHECK(ingest::sockets_on(table, 7502) == std::vector<std::uint64_t>{4711});
  CHECK(ingest::sockets_on(table, 7503) == std::vector<std::uint64_t>{4712});
  CHECK(ingest::sockets_on(table, 1).empty());
  CHECK(ingest::sockets_on("", 7502).empty());
}

TEST_CASE("the owner of a port of our own is this process") {
  const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof address;
  REQUIRE(::bind(fd, reinterpret_cast<sockaddr*>(&address), size) == 0);
  REQUIRE(::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0);
  const auto owner = ingest::owner_of_port(ntohs(address.sin_port));
  ::close(fd);
  REQUIRE(owner);
  CHECK(owner->pid == ::getpid());
  CHECK(owner->command.find("test_ctl") != std::string::npos);
  CHECK(!ingest::owner_of_port(ntohs(address.sin_port)));
}

TEST_CASE("findings: an error decides, a warning does not") {
  using ctl::Level;
  CHECK(!ctl::has_error({{Level::ok, "a", ""}, {Level::warning, "b", ""}}));
  CHECK(ctl::has_error({{Level::ok, "a", ""}, {Level::error, "b", ""}}));
  CHECK(ctl::to_table({{Level::warning, "pools", "too small"}}) == "warning  pools             too small\n");
}
