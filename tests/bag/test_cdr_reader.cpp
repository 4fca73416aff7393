// CDR from a buffer that nobody vouches for.
#include <catch2/catch.hpp>

#include "services/common/ros/incoming.hpp"
#include "tests/support/ros_messages.hpp"

using namespace gvom;
using namespace gvom::ros;
using namespace gvom::test;

namespace {

Bytes view(const Octets& octets) {
  return {octets.data(), octets.size()};
}

/// Each length from none to one byte short must be refused, and no byte beyond it read (asan sees to that).
template <typename ReadMessage>
void require_refused_when_cut(const Octets& whole, std::size_t needed, ReadMessage read_message) {
  for (std::size_t size = 0; size < needed; ++size) {
    const Octets cut(whole.begin(), whole.begin() + static_cast<long>(size));
    INFO("cut to " << size);
    REQUIRE_FALSE(read_message(view(cut)).has_value());
  }
}

}  // namespace

TEST_CASE("numbers are aligned to their own size, from behind the head, in both byte orders") {
  for (const bool big_endian : {false, true}) {
    const Octets octets = CdrWriter(big_endian)
                              .add(std::uint8_t{7})
                              .add(std::uint32_t{0x01020304})
                              .add(std::uint8_t{8})
                              .add(2.5)
                              .text("odom")
                              .add(std::uint16_t{9})
                              .bytes();
    CdrReader cdr(view(octets));
    CHECK(cdr.is_big_endian() == big_endian);
    CHECK(cdr.read<std::uint8_t>() == 7);
    CHECK(cdr.read<std::uint32_t>() == 0x01020304);
    CHECK(cdr.read<std::uint8_t>() == 8);
    CHECK(cdr.read<double>() == 2.5);
    CHECK(cdr.string(10) == "odom");
    CHECK(cdr.read<std::uint16_t>() == 9);
    CHECK(cdr.left() == 0);
    CHECK(cdr.ok());
  }
}

TEST_CASE("the first error stays, and everything after it reads as nothing") {
  const Octets octets = CdrWriter().add(std::uint16_t{5}).bytes();
  CdrReader cdr(view(octets));
  CHECK(cdr.read<std::uint64_t>() == 0);
  CHECK(cdr.error() == "byte 4: the message ends before 8 bytes that should follow");
  CHECK(cdr.read<std::uint16_t>() == 0);
  CHECK(cdr.string(10).empty());
  CHECK(cdr.octets().size == 0);
  CHECK(cdr.error() == "byte 4: the message ends before 8 bytes that should follow");
}

TEST_CASE("what is not CDR is refused by its encoding") {
  const Octets octets{0, 7, 0, 0, 1, 2, 3, 4};
  CdrReader cdr(view(octets));
  CHECK(cdr.error() == "byte 0: encoding 0x0007 is not CDR (0x0000, 0x0001)");
}

TEST_CASE("counts and lengths that the message cannot hold are refused before anything is made of them") {
  const Octets huge = CdrWriter().add(std::uint32_t{0xFFFFFFFF}).bytes();
  std::vector<TransformIn> transforms;
  CHECK(read_transforms(view(huge), transforms).error() ==
        "byte 8: a sequence of 4294967295 elements, more than the message can hold");
  CHECK(transforms.capacity() == 0);
  CdrReader text(view(huge));
  CHECK(text.string(4096).empty());
  CHECK(text.error() == "byte 8: a string of 4294967294 bytes, more than 4096");
  const Octets open_text = CdrWriter().add(std::uint32_t{2}).raw({'a', 'b'}).bytes();
  CdrReader without_nul(view(open_text));
  CHECK(without_nul.string(4096).empty());
  CHECK_FALSE(without_nul.ok());
}

TEST_CASE("an odometry's pose, stamp and frames") {
  const Octets octets = odometry_message(1'700'000'000'123'456'789, 3.25, "base");
  OdometryIn odometry;
  REQUIRE(read_odometry(view(octets), odometry).has_value());
  CHECK(odometry.header.stamp_ns == 1'700'000'000'123'456'789);
  CHECK(odometry.header.frame_id == "odom");
  CHECK(odometry.child_frame_id == "base");
  CHECK(odometry.position_m == std::array<double, 3>{3.25, 0, 0});
  CHECK(odometry.orientation_xyzw == std::array<double, 4>{0, 0, 0, 1});
  const std::size_t needed = 4 + 32 + 56;  // stamp 8, "odom" 12, "base" 12 with counts, NULs and padding
  require_refused_when_cut(octets, needed, [&](Bytes bytes) { return read_odometry(bytes, odometry); });
}

TEST_CASE("a time of more than its second is refused") {
  const Octets octets = CdrWriter().add(std::int32_t{1}).add(std::uint32_t{1'000'000'000}).text("").bytes();
  HeaderIn header;
  CHECK(read_header(view(octets), header).error() ==
        "byte 12: a time with 1000000000 nanoseconds past its second");
}

TEST_CASE("transforms: each with its frames and stamp") {
  const Octets octets = tf_message({{"odom", "base_link", 5'000'000'007, {1, 2, 3}, {0, 0, 1, 0}},
                                    {"map", "odom", 6, {4, 5, 6}, {0, 0, 0, 1}}});
  std::vector<TransformIn> transforms;
  REQUIRE(read_transforms(view(octets), transforms).has_value());
  REQUIRE(transforms.size() == 2);
  CHECK(transforms[0].header.stamp_ns == 5'000'000'007);
  CHECK(transforms[0].child_frame_id == "base_link");
  CHECK(transforms[0].rotation_xyzw == std::array<double, 4>{0, 0, 1, 0});
  CHECK(transforms[1].header.frame_id == "map");
  CHECK(transforms[1].translation_m == std::array<double, 3>{4, 5, 6});
  require_refused_when_cut(octets, octets.size(),
                           [&](Bytes bytes) { return read_transforms(bytes, transforms); });
}

TEST_CASE("a scan's packets lie on four bytes, and the last one may lack its padding") {
  const std::vector<Octets> packets{Octets(kVelodynePacketBytes, 1), Octets(kVelodynePacketBytes, 2),
                                    Octets(kVelodynePacketBytes, 3)};
  Octets octets = velodyne_message(10'000'000'000, packets, 1'000'000);
  HeaderIn header;
  std::vector<VelodynePacketIn> read;
  for (const bool padded : {false, true}) {
    if (padded) octets.insert(octets.end(), 3, 0);
    REQUIRE(read_velodyne_scan(view(octets), header, read).has_value());
    REQUIRE(read.size() == 3);
    CHECK(read[2].stamp_ns == 10'002'000'000);
    CHECK(Octets(read[2].data, read[2].data + kVelodynePacketBytes) == packets[2]);
  }
}

TEST_CASE("a cloud's fields and data, and an Ouster packet's bytes") {
  const Octets data(4 * 12, 9);
  const Octets octets = cloud_message(7, {{{"x", 0, 7}, {"t", 8, 6}}, 12, 2}, data);
  PointCloud2In cloud;
  REQUIRE(read_point_cloud(view(octets), cloud).has_value());
  CHECK(cloud.width == 2);
  CHECK(cloud.height == 2);
  REQUIRE(cloud.fields.size() == 2);
  CHECK(cloud.fields[1].name == "t");
  CHECK(cloud.fields[1].offset_bytes == 8);
  CHECK(cloud.fields[1].datatype == PointFieldIn::uint32);
  CHECK(cloud.row_step == 24);
  CHECK(cloud.data.size == 48);
  require_refused_when_cut(octets, octets.size() - 1,
                           [&](Bytes bytes) { return read_point_cloud(bytes, cloud); });

  Bytes packet;
  const Octets message = ouster_message({1, 2, 3});
  REQUIRE(read_ouster_packet(view(message), packet).has_value());
  CHECK(Octets(packet.data, packet.data + packet.size) == Octets{1, 2, 3});
}
