// Small MCAP files of every layout, and a message of each type.
#include "tests/fuzz/seeds.hpp"
#include "tests/support/mcap_builder.hpp"
#include "tests/support/ros_messages.hpp"

namespace gvom::fuzz {
namespace {

using namespace test;

void add_mcaps(Seeds& seeds) {
  for (const char* compression : {"", "lz4", "zstd"})
    for (const std::size_t chunk : {0, 2})
      for (const bool whole : {true, false}) {
        McapBuilder file({compression, chunk, whole, whole});
        const auto a = file.topic("/a", "A");
        const auto b = file.topic("/b", "B");
        for (int i = 0; i < 5; ++i)
          file.add(i % 2 == 0 ? a : b, 10 - i, Octets(20, static_cast<std::uint8_t>(i)));
        seeds.add("mcap", file.bytes());
      }
}

void add_message(Seeds& seeds, std::uint8_t type, const Octets& message) {
  Octets input{type};
  input.insert(input.end(), message.begin(), message.end());
  seeds.add("ros", input);
}

}  // namespace

void add_bags(Seeds& seeds) {
  add_mcaps(seeds);
  add_message(seeds, 0, odometry_message(1'700'000'000'000'000'000, 1));
  add_message(seeds, 1,
              tf_message({{"odom", "base", 1}, {"odom", "base", 2, {1, 0, 0}}, {"base", "base_link", 0}}));
  for (const bool big_endian : {false, true}) {
    CloudLayout layout{{{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"t", 14, 6}}, 18, 2};
    layout.row_padding = 3;
    layout.big_endian = big_endian;
    add_message(seeds, 2, cloud_message(1'700'000'000'000'000'000, layout, Octets(2 * (3 * 18 + 3), 0x3F)));
    add_message(seeds, 3, cloud_message(5, layout, Octets(2 * (3 * 18 + 3), 1)));
  }
  add_message(seeds, 4, ouster_message(Octets(50, 1)));
  add_message(seeds, 5, velodyne_message(7, {Octets(1206, 1)}));
  const std::string metadata = "x:\n  relative_file_paths:\n    - a/b.db3\n    - \"c.mcap\"\n  d: e\n";
  add_message(seeds, 6, Octets(metadata.begin(), metadata.end()));
}

}  // namespace gvom::fuzz
