// The private network of these tests.
#pragma once

#include <fstream>
#include <memory>

#include <catch2/catch.hpp>

#include "services/common/dds/participant.hpp"

namespace gvom::dds::test {

inline constexpr std::size_t kCloudBytes = 3'840'000;  // 120,000 points of 32 bytes

inline std::shared_ptr<Participant> join(int domain, Distro distro = Distro::jazzy) {
  ParticipantOptions options;
  options.domain.id = domain;
  options.domain.interface = "lo";
  options.node = "/gvom/bridge";
  options.distro = distro;
  auto participant = Participant::open(options);
  INFO((participant ? "" : participant.error()));
  REQUIRE(participant);
  return *participant;
}

/// Large messages need what gvomctl check asks for; says so where it is not.
inline bool has_large_buffers() {
  long most_bytes = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> most_bytes;
  if (most_bytes >= 4 << 20) return true;
  WARN("SKIPPED: net.core.rmem_max is " << most_bytes << ", so no messages of 4 MB from or to DDS peers");
  return false;
}

}  // namespace gvom::dds::test
