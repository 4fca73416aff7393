// fuzz_seeds DIR: writes the first inputs of every fuzz target to DIR/TARGET/. Synthetic, nothing recorded.
#include <zlib.h>

#include "tests/fuzz/seeds.hpp"

#include <initializer_list>

#include "tests/ingest/ouster_builder.hpp"

using namespace gvom;
using namespace gvom::fuzz;
using namespace gvom::test;

namespace {

using Bytes = std::initializer_list<std::uint8_t>;

// As fuzz_ouster numbers them.
constexpr const char* kProfiles[] = {"LEGACY",
                                     "RNG15_RFL8_NIR8",
                                     "RNG19_RFL8_SIG16_NIR16",
                                     "RNG19_RFL8_SIG16_NIR16_DUAL",
                                     "FUSA_RNG15_RFL8_NIR8_DUAL",
                                     "RNG15_RFL8_NIR8_ZONE16",
                                     "RNG19_RFL8_SIG16_NIR16_RGB16",
                                     "RNG19_RFL8_SIG16_NIR16_RGB16_DUAL"};

ByteVector file_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Two frames of each profile; live, with a hint of the time in front.
void add_ouster(Seeds& seeds) {
  for (std::uint8_t profile = 0; profile < 8; ++profile) {
    for (const std::uint8_t how : Bytes{0, 4, 8, 16}) {
      OusterSensor sensor;
      sensor.profile = kProfiles[profile];
      ByteVector input{static_cast<std::uint8_t>((profile & 3) | (profile & 4) << 3 | how)};
      if (how == 4) input.resize(9);
      for (int packet = 0; packet < 8; ++packet) {
        input.push_back(4);
        append(input, plain_packet(sensor, packet / 4, packet % 4 * 4));
      }
      seeds.add("ouster", input);
    }
    OusterSensor sensor;
    sensor.profile = kProfiles[profile];
    seeds.add("metadata", sensor.json());
  }
  seeds.add("metadata",
            std::string(R"({"beam_intrinsics": {"beam_altitude_angles": [1], "beam_azimuth_angles": )"
                        R"([2], "beam_to_lidar_transform": [1,0,0,9,0,1,0,0,0,0,1,7,0,0,0,1]}, )"
                        R"("config_params": {"lidar_mode": "64x10", "udp_profile_lidar": "LEGACY"}, )"
                        R"("sensor_info": {"prod_sn": "992200"}})"));
}

/// A packet of twelve blocks from `azimuth` on, 40 hundredths of a degree each; a return at each fourth
/// laser.
ByteVector velodyne_packet(int azimuth, std::uint32_t time_us, std::uint8_t mode, std::uint8_t model) {
  ByteVector out;
  const int banks = model == 0xA1 ? 4 : model == 0 ? 2 : 1;
  for (int block = 0; block < 12; ++block) {
    const int bank = (mode == 0x39 && banks != 2 ? block / 2 : block) % banks;
    append(out, {0xFF, static_cast<std::uint8_t>(0xEE - 0x11 * bank)});
    put_le(out, static_cast<std::uint16_t>((azimuth + 40 * (mode == 0x39 ? block / 2 : block)) % 36000));
    for (int laser = 0; laser < 32; ++laser) {
      put_le(out, static_cast<std::uint16_t>(laser % 4 == 0 ? 1000 + block : 0));
      out.push_back(99);
    }
  }
  put_le(out, time_us);
  append(out, {mode, model});
  return out;
}

void add_velodyne(Seeds& seeds) {
  for (const std::uint8_t how : Bytes{0, 1, 2, 3, 8, 12, 16, 32, 33}) {
    const std::uint8_t model = how == 1    ? 0x28
                               : how == 2  ? 0x21
                               : how == 3  ? 0xA1
                               : how == 32 ? 0x24
                               : how == 33 ? 0
                                           : 0x22;
    for (const std::uint8_t mode : Bytes{0x37, 0x39}) {
      ByteVector input{how};
      if (how == 12) input.resize(9);
      for (int packet = 0; packet < 3; ++packet) {
        input.push_back(4);
        append(input, velodyne_packet((35100 + packet * 480) % 36000,
                                      static_cast<std::uint32_t>(packet) * 1327, mode, model));
      }
      seeds.add("velodyne", input);
    }
  }
}

void add_calibration(Seeds& seeds) {
  std::string text = "num_lasers: 64\ndistance_resolution: 0.002\nlasers:\n";
  for (int i = 0; i < 64; ++i)
    text += "- {laser_id: " + std::to_string(i) + ", rot_correction: 0.1, vert_correction: 0." +
            std::to_string(100 + i) + ", dist_correction: 1.2}\n";
  seeds.add("calibration", text);
  seeds.add("calibration", std::string("lasers: [{laser_id: 0, two_pt_correction_available: true}]\n"));
}

void add_frame(ByteVector& input, const ByteVector& bytes) {
  put_le(input, static_cast<std::uint16_t>(bytes.size()));
  input.push_back(1);
  append(input, bytes);
}

void add_captures(Seeds& seeds) {
  const ByteVector payload(50, 0x55);
  std::vector<ByteVector> frames = {frame(payload), ethernet(ipv6(udp(payload)), 0x86DD)};
  for (const ByteVector& part : fragments(payload, 24)) frames.push_back(part);
  ByteVector one{0}, raw{10};
  for (const ByteVector& bytes : frames) {
    add_frame(one, bytes);
    add_frame(raw, ByteVector(bytes.begin() + 14, bytes.end()));
  }
  const ByteVector ip(frames[0].begin() + 14, frames[0].end());
  const ByteVector cooked{0, 0, 0,    1,    0, 6, 0,    0,    0, 0, 0,    0,
                          0, 0, 0x88, 0xA8, 0, 5, 0x81, 0x00, 0, 6, 0x08, 0x00};
  ByteVector tagged{2}, ppp{16};
  for (const ByteVector& header : {cooked, ByteVector{0xFF, 0x03, 0x00, 0x21}}) {
    ByteVector bytes = header;
    append(bytes, ip);
    add_frame(header == cooked ? tagged : ppp, bytes);
  }
  seeds.add("frames", tagged);
  seeds.add("frames", ppp);
  seeds.add("frames", one);
  seeds.add("frames", raw);

  const std::string path = std::filesystem::temp_directory_path() / "gvom-fuzz-seed.pcap";
  for (const std::uint32_t link_type : {1, 101, 113, 276}) {
    for (const bool nanoseconds : {false, true}) {
      PcapWriter pcap(path, link_type, nanoseconds);
      for (const ByteVector& bytes : frames) pcap.add(bytes, 1'500'000'000);
      seeds.add("pcap", file_bytes(pcap.write()));
    }
  }
  PcapWriter snapped(path, 1);
  for (const ByteVector& bytes : frames) snapped.add(bytes, 1'500'000'000, 4);
  seeds.add("pcap", file_bytes(snapped.write()));
  const ByteVector plain = file_bytes(path);
  const gzFile packed = ::gzopen(path.c_str(), "wb");
  ::gzwrite(packed, plain.data(), static_cast<unsigned>(plain.size()));
  ::gzclose(packed);
  seeds.add("pcap", file_bytes(path));
  std::filesystem::remove(path);
  ByteVector ng;  // a section, an interface, a packet
  for (const std::uint32_t word : {0x0A0D0D0Au, 28u, 0x1A2B3C4Du, 0x00000001u, ~0u, ~0u, 28u})
    put_le(ng, word);
  for (const std::uint32_t word : {1u, 20u, 1u, 262144u, 20u}) put_le(ng, word);
  const auto size = static_cast<std::uint32_t>(frames[0].size());
  const std::uint32_t padded = (size + 3) / 4 * 4;
  for (const std::uint32_t word : {6u, 32u + padded, 0u, 0u, 1000u, size, size}) put_le(ng, word);
  append(ng, frames[0]);
  ng.resize(ng.size() + padded - size);
  put_le(ng, 32u + padded);
  seeds.add("pcap", ng);
}

void add_clouds(Seeds& seeds) {
  using namespace std::string_literals;
  const std::string header =
      "VERSION 0.7\nFIELDS x y z t\nSIZE 4 4 4 8\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS "
      "2\nDATA ";
  for (const std::string& data :
       {"ascii\n1 2 3 4\n5 6 7 8\n"s, "binary\n0123456789012345678901234567890123456789"s,
        "binary_compressed\n\x2a\0\0\0\x28\0\0\0\x1f"s + "01234567890123456789012345678901" + "\x07" +
            "01234567"}) {
    seeds.add("pcd", header + data);
    seeds.add("scans", "\x01"s + header + data);
    seeds.add("scans", "\x03\x04\x00"s + "1.5\n" + header + data);
  }
  seeds.add("pcd",
            "FIELDS x i u\nSIZE 8 2 1\nTYPE F I U\nCOUNT 1 1 3\nPOINTS 1\nDATA ascii\n1e3 -5 6 7 8\n"s);
  const std::string padded =
      "FIELDS x y z _ none timestamp\nSIZE 4 4 4 1 2 8\nTYPE F F F U U F\nCOUNT 1 1 1 2 0 1\nWIDTH 2\nHEIGHT "
      "1\nDATA ";
  seeds.add("pcd", padded + "ascii\n1 2 3 0 0 1.7e18\n4 5 6 0 0 1.70000000005e18\n"s);
  seeds.add("scans", "\x01"s + padded + "ascii\n1 2 3 0 0 1.7e18\n4 5 6 0 0 1.70000000005e18\n");
  seeds.add("scans", "\x00"s + std::string(32, '\x3f'));
  std::string five;  // x y z intensity ring
  for (int i = 0; i < 50; ++i)
    for (const float value : {10.F + static_cast<float>(i), -3.5F, 0.7F, 40.F, static_cast<float>(i % 32)})
      five.append(reinterpret_cast<const char*>(&value), sizeof value);
  seeds.add("scans", "\x00"s + five);
  seeds.add("scans", "\x02\x09\x00"s + "12345.678" + std::string(16, '\x40'));
}

void add_texts(Seeds& seeds) {
  seeds.add("tum", std::string("# t x y z qx qy qz qw\n1.5 1 2 3 0 0 0.6 0.8\n\n2.25e0 4 5 6 0 0 0 -1\r\n"));
  seeds.add(
      "tum",
      std::string("\xEF\xBB\xBF#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
                  "q_RS_y [], q_RS_z []\n1403715524907143168,1,2,3,1,0,0,0,9\n"));
  seeds.add("tum", std::string("1 0 0 5 0 1 0 6 0 0 1 7\n0 -1 0 8 1 0 0 9 0 0 1 1e1\n"));
  seeds.add("tum", std::string("2011-09-26 13:02:25.594360375\n2011-09-26T13:02:26Z\n"));
  seeds.add("tum", std::string("1311868163.869999886 -1e-3 +2 .5 1 0 0 0\n"));
  for (const char* uri :
       {"ouster:a.pcap?meta=b.json&port=7502", "velodyne-udp:2368?model=VLP-16&bind=10.0.0.1", "scans:folder",
        "ouster-udp:7502?meta=c", "ouster-udp:7502?group=239.201.201.201&interface=eth1&from=10.0.0.7",
        "velodyne-udp:2368?model=VLP-16&bind=fe80::1%eth1"}) {
    seeds.add("uri", std::string(uri));
  }
  const std::string vehicles = GVOM_SOURCE_DIR "/config/vehicles/";
  for (const auto& entry : std::filesystem::directory_iterator(vehicles)) {
    seeds.add("config", file_bytes(entry.path()));
  }
  const std::string small =
      "name: a\nlidars: {b: {T_base_sensor: {x: 0, y: 1, z: 2, roll: 0, pitch: 0, yaw: 3}}}\n";
  using namespace std::string_literals;
  seeds.add("config", small + "\0map.size_xy=64\0lidars.b.source='scans:x'\0vehicle.body_min_m=[1, 2, 3]"s);
  seeds.add("config", small);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 64;
  Seeds seeds(argv[1]);
  add_ouster(seeds);
  add_velodyne(seeds);
  add_calibration(seeds);
  add_captures(seeds);
  add_clouds(seeds);
  add_texts(seeds);
  add_messages(seeds);
  add_bags(seeds);
  add_clients(seeds);
  return 0;
}
