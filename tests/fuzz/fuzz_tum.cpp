// Odometry recordings, read as each of the formats, and the times that they share with times.txt.
#include <cmath>

#include "services/common/odometry_file.hpp"
#include "services/common/stamps.hpp"
#include "tests/fuzz/memory_file.hpp"

using namespace gvom;
using namespace gvom::fuzz;

namespace {

void check(const std::string& source) {
  std::vector<std::string> warnings;
  const auto poses = services::read_odometry_source(source, warnings);
  require(poses || !poses.error().empty(), "an error says what it is");
  if (!poses) return;
  require(!poses->empty(), "a recording has a pose");
  for (std::size_t i = 0; i < poses->size(); ++i) {
    const Pose& pose = (*poses)[i].T_odom_base;
    require(pose.translation_m.allFinite(), "a position is finite");
    require(std::abs(pose.rotation.norm() - 1) < 1e-9, "a rotation is a unit quaternion");
    require(i == 0 || (*poses)[i].stamp_ns > (*poses)[i - 1].stamp_ns, "time goes on");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MemoryFile file;
  file.set(data, size);
  const std::string text(reinterpret_cast<const char*>(data), size);
  (void)services::parse_stamp_ns(text.substr(0, text.find_first_of(" \n")));
  (void)services::read_stamps(file.path());
  for (const std::string& source :
       {"tum:" + file.path(), "euroc:" + file.path(), "kitti:" + file.path() + "?times=" + file.path()})
    check(source);
  return 0;
}
