#include <catch2/catch.hpp>

#include <string>

#include "services/common/dds/participant.hpp"
#include "tests/common/temporary_file.hpp"

using namespace gvom::dds;
using Catch::Contains;

namespace {

std::string error_of(const ParticipantOptions& options) {
  const auto participant = Participant::open(options);
  return participant ? "" : participant.error();
}

}  // namespace

TEST_CASE("an interface that is not there is an error in Cyclone's words, again and again") {
  ParticipantOptions options;
  options.domain.interface = "nosuch0";
  for (int i = 0; i < 3; ++i) CHECK_THAT(error_of(options), Contains("nosuch0"));
}

TEST_CASE("a user's file that Cyclone does not understand is an error in its words") {
  ParticipantOptions options;
  const gvom::test::TemporaryFile file("<CycloneDDS><Domain><Genral/></Domain></CycloneDDS>");
  options.domain.config_file = file.path();
  CHECK_THAT(error_of(options), Contains("Genral"));
}

TEST_CASE("a file that ends within an element is an error") {
  ParticipantOptions options;
  const gvom::test::TemporaryFile file("<CycloneDDS><Domain><General>");
  options.domain.config_file = file.path();
  CHECK_FALSE(error_of(options).empty());
}

TEST_CASE("buffers that the kernel does not give are an error, not the end") {
  ParticipantOptions options;
  const gvom::test::TemporaryFile file(
      "<CycloneDDS><Domain><Internal><SocketReceiveBufferSize "
      "min=\"2000MB\"/></Internal></Domain></CycloneDDS>");
  options.domain.config_file = file.path();
  CHECK_FALSE(error_of(options).empty());
}

TEST_CASE("a node's name that ROS refuses is an error") {
  ParticipantOptions options;
  options.node = "gvom";
  CHECK(error_of(options) == "ROS 2: node 'gvom' does not begin with a slash");
}
