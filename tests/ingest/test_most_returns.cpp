// The room that a sensor's sweeps need.
#include <unistd.h>

#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using namespace gvom::ingest;

TEST_CASE("what a sweep can have is held against max_returns") {
  TemporaryFolder folder;
  OusterSensor sensor;
  sensor.beams = 128;
  sensor.columns = 1024;
  sensor.window = "[0, 1023]";
  sensor.altitudes = "[";
  sensor.azimuths = "[";
  for (int beam = 0; beam < 128; ++beam) {
    sensor.altitudes += (beam == 0 ? "" : ", ") + std::to_string(20.0 - 0.3 * beam);
    sensor.azimuths += beam == 0 ? "3" : beam % 2 == 0 ? ", 3" : ", -3";
  }
  sensor.altitudes += "]";
  sensor.azimuths += "]";
  for (const auto& [profile, returns] :
       {std::pair("LEGACY", 131072U), {"RNG19_RFL8_SIG16_NIR16_DUAL", 262144U}}) {
    sensor.profile = profile;
    const std::string meta = write_text(folder.path() + "/meta.json", sensor.json());
    const auto source = open("ouster-udp:" + std::to_string(20000 + ::getpid() % 20000) + "?meta=" + meta);
    CHECK(source->most_returns() == returns);
    CHECK(lack_of_room("front", returns, *source).empty());
    const std::string lack = lack_of_room("front", 65536, *source);
    CHECK(lack.find("lidars.front.max_returns is 65536") == 0);
    CHECK(lack.find(std::to_string(returns)) != std::string::npos);
  }
  const auto port = std::to_string(20000 + ::getpid() % 20000);
  const auto single = open("velodyne-udp:" + port + "?model=VLP-32C&returns=single")->most_returns();
  const auto dual = open("velodyne-udp:" + port + "?model=VLP-32C&returns=dual")->most_returns();
  CHECK(dual == 2 * single);
  CHECK(dual > 65536);
}
