// One lidar that goes round in a circle: steady ticks of a back end, through a segment of shared memory.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/mapper.hpp"
#include "tests/core/random.hpp"
#include "tests/cuda/segment.hpp"

namespace gvom::test {

class Drive {
 public:
  /// Error: the back end does not start.
  static DeviceExpected<std::unique_ptr<Drive>> open(Backend backend);

  /// One sweep: counted, written, fused, made into layers. False if the back end says that it failed.
  bool step();
  /// What it said.
  [[nodiscard]] const std::string& failure() const { return failure_; }
  /// The last layers, all arrays.
  [[nodiscard]] std::string layer_bytes() const {
    return {reinterpret_cast<const char*>(layers_.height), layers_.bytes_in_one};
  }
  [[nodiscard]] std::optional<DeviceCosts> costs() const { return fuser_->backend().last_costs(); }

 private:
  Drive();
  [[nodiscard]] Pose pose() const;
  bool fail(const std::string& what);

  Segment segment_;
  std::unique_ptr<SweepMapper> mapper_;
  std::unique_ptr<MapFuser> fuser_;
  LayerArrays layers_;
  OdometryBuffer odometry_;
  Sweep sweep_;
  Random random_{5};
  std::uint64_t steps_ = 0;
  std::string failure_;
};

}  // namespace gvom::test
