#include "tests/processes/graph.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>

namespace gvom::test {

std::vector<std::string> Vehicle::arguments(const std::vector<std::string>& more) const {
  std::vector<std::string> result{"--config", file};
  for (const std::string& set : sets) result.insert(result.end(), {"--set", set});
  result.insert(result.end(), more.begin(), more.end());
  return result;
}

std::uint16_t free_port() {
  const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  REQUIRE(::bind(fd, reinterpret_cast<sockaddr*>(&address), size) == 0);
  REQUIRE(::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0);
  ::close(fd);
  return ntohs(address.sin_port);
}

std::vector<std::string> small_map() {
  return {"map.size_xy=128", "map.size_z=32", "window.buffer_size=4", "ipc.max_planners=2"};
}

Graph::Graph(Vehicle vehicle) : vehicle_(std::move(vehicle)), roudi_(start("gvom-roudi", {})) {
  const bool up = roudi_->says("is up");
  INFO(roudi_->output());
  REQUIRE(up);
}

std::unique_ptr<Program> Graph::start(const std::string& name,
                                      const std::vector<std::string>& arguments) const {
  return std::make_unique<Program>(name, vehicle_.arguments(arguments), vehicle_.folder);
}

void Graph::start_fusion() {
  fusion_ = start("gvom-fusion" + vehicle_.variant, {});
}

void Graph::start_ingest(const std::string& lidar) {
  ingests_[lidar] = start("gvom-ingest" + vehicle_.variant, {"--lidar", lidar});
}

void Graph::start_readers() {
  start_fusion();
  for (const std::string& lidar : vehicle_.lidars) start_ingest(lidar);
}

std::unique_ptr<Program> Graph::replay(const std::vector<std::string>& arguments) const {
  return start("gvom-odometry", arguments);
}

void Graph::play_through(const std::string& rate) const {
  const auto odometry = replay({"--rate", rate});
  const int code = odometry->wait();
  INFO(odometry->output());
  REQUIRE(code == 0);
}

void Graph::lose_ingest(const std::string& lidar) {
  CHECK(ingest(lidar).kill_asleep() == 128 + SIGKILL);
  ingests_.erase(lidar);
}

void Graph::stop(int signal) {
  const auto end = [&](const std::string& name, Program& program) {
    const int code = program.stop(signal);
    INFO(name << ": " << program.output());
    CHECK(code == 0);
  };
  for (auto& [lidar, ingest] : ingests_) end("gvom-ingest " + lidar, *ingest);
  if (fusion_) end("gvom-fusion", *fusion_);
  end("gvom-roudi", *roudi_);
}

}  // namespace gvom::test
