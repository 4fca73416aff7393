#include <catch2/catch.hpp>

#include <fstream>
#include <string>

#include "services/common/dds/domain.hpp"
#include "tests/common/temporary_file.hpp"

using namespace gvom::dds;
using Catch::Contains;

TEST_CASE("Cyclone's configuration is ours: no shared memory, what the kernel gives of buffers") {
  DomainOptions options;
  options.interface = "lo";
  options.peers = {"10.0.0.7", "robot.local"};
  const std::string xml = domain_xml(options).value();
  CHECK_THAT(xml, Contains("<SharedMemory><Enable>false</Enable></SharedMemory>"));
  CHECK_THAT(xml, Contains("<SocketReceiveBufferSize max=\"16MB\"/>"));
  CHECK_THAT(xml, Contains("<NetworkInterface name=\"lo\" multicast=\"true\"/>"));
  CHECK_THAT(xml, Contains("<Peer address=\"10.0.0.7\"/><Peer address=\"robot.local\"/>"));
  options.interface = "192.168.1.5";
  CHECK_THAT(domain_xml(options).value(), Contains("<NetworkInterface address=\"192.168.1.5\"/>"));
}

TEST_CASE("domains, interfaces and peers that cannot be are refused") {
  const auto error = [](int id, const std::string& interface, const std::string& peer) {
    return domain_xml({id, interface, {peer}, ""}).error();
  };
  CHECK(error(233, "", "a") == "domain 233 is not within 0 .. 232");
  CHECK(error(-1, "", "a") == "domain -1 is not within 0 .. 232");
  CHECK(error(0, "lo\"/><x", "a") == "interface 'lo\"/><x' is no name or address");
  CHECK(error(0, "", "a<b") == "peer 'a<b' is no name or address");
  CHECK(error(0, "", "") == "peer '' is no name or address");
}

TEST_CASE("a user's file comes after ours, but never brings shared memory") {
  DomainOptions options;
  const auto with_file = [&](const std::string& text) {
    const gvom::test::TemporaryFile file(text);
    options.config_file = file.path();
    return domain_xml(options);
  };
  const std::string tracing =
      "<CycloneDDS><Domain><Tracing><Verbosity>none</Verbosity></Tracing></Domain></CycloneDDS>";
  const std::string xml = with_file("\n " + tracing).value();
  CHECK(xml.find(tracing) > xml.find("MaxMessageSize"));
  CHECK(xml.rfind("<SharedMemory><Enable>false</Enable>") > xml.find(tracing));

  CHECK_THAT(with_file("<CycloneDDS><Domain><sharedMEMORY/></Domain></CycloneDDS>").error(),
             Contains("speaks of SharedMemory"));
  CHECK_THAT(with_file("/etc/cyclone.xml").error(), Contains("is not XML"));
  CHECK_THAT(with_file("").error(), Contains("is not XML"));
  CHECK_THAT(with_file("<" + std::string(1 << 20, 'x')).error(), Contains("larger than 1 MiB"));
  options.config_file = "/nowhere/cyclone.xml";
  CHECK(domain_xml(options).error() ==
        "Cyclone's file '/nowhere/cyclone.xml' cannot be read: No such file or directory");
}
