// The VLP-16 decoder against points that another decoder made of the same packets.
#include <sqlite3.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "services/ingest/bytes.hpp"
#include "services/ingest/pcd.hpp"
#include "tests/ingest/frames_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;

namespace {

constexpr std::size_t kPacketSize = 1206;

/// The payloads of a CDR-encoded velodyne_msgs/VelodyneScan: header {stamp, frame_id}, then packets
/// {stamp, 1206 bytes}, everything on 4 bytes.
void add_packets(const std::uint8_t* cdr, std::size_t size, PcapWriter& pcap) {
  const auto word = [cdr](std::size_t at) { return ingest::load_le<std::uint32_t>(cdr + at); };
  std::size_t at = 16 + (word(12) + 3) / 4 * 4;
  const std::uint32_t count = word(at);
  at += 4;
  REQUIRE(at + count * (8 + kPacketSize + 2) <= size + 2);
  for (std::uint32_t i = 0; i < count; ++i, at += 8 + kPacketSize + 2) {
    const std::int64_t stamp_ns = std::int64_t{word(at)} * 1'000'000'000 + word(at + 4);
    pcap.add(frame(ByteVector(cdr + at + 8, cdr + at + 8 + kPacketSize)), stamp_ns);
  }
}

void add_all_scans(const std::string& database, PcapWriter& pcap) {
  sqlite3* db = nullptr;
  // immutable: the folder of the recordings may be read-only.
  REQUIRE(sqlite3_open_v2(("file:" + database + "?immutable=1").c_str(), &db,
                          SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr) == SQLITE_OK);
  sqlite3_stmt* query = nullptr;
  REQUIRE(sqlite3_prepare_v2(db, "SELECT data FROM messages ORDER BY timestamp", -1, &query, nullptr) ==
          SQLITE_OK);
  while (sqlite3_step(query) == SQLITE_ROW) {
    add_packets(static_cast<const std::uint8_t*>(sqlite3_column_blob(query, 0)),
                static_cast<std::size_t>(sqlite3_column_bytes(query, 0)), pcap);
  }
  sqlite3_finalize(query);
  sqlite3_close(db);
}

double distance_to_nearest(const Sweep& sweep, const Return& p) {
  double best = 1e9;
  for (const Return& r : sweep.returns) {
    best = std::min(best, std::hypot(r.x_m - p.x_m, r.y_m - p.y_m, r.z_m - p.z_m));
  }
  return best;
}

/// Of the truth's points, those whose azimuth its decoder interpolated right. The recording is in dual return
/// mode, and that decoder holds the azimuth within the last pair of blocks of each packet, and takes it from
/// the next pair for a return that only the second block of a pair has: such points lie up to 0.4 degrees
/// from where the laser pointed.
std::vector<Return> interpolated_points(const ingest::PcdCloud& cloud) {
  constexpr std::int64_t kBlockNs = 48 * 2304;  // as it counts them: 48 laser slots of 2.304 us each
  std::vector<Return> out;
  for (std::size_t i = 0; i < cloud.points; ++i) {
    const std::int64_t block = cloud.integer(*cloud.find("time_stamp"), i) / kBlockNs;
    const bool interpolated = block % 2 == 0 && block != 10;
    if (!interpolated) continue;
    out.push_back({cloud.number(*cloud.find("x"), i), cloud.number(*cloud.find("y"), i),
                   cloud.number(*cloud.find("z"), i), 0});
  }
  return out;
}

}  // namespace

TEST_CASE("VLP-16 returns agree with an independent decoder's to a centimetre") {
  const auto data = recordings();
  if (!data) return;
  TemporaryFolder folder;
  PcapWriter pcap(folder.path() + "/vlp16.pcap");
  add_all_scans(*data + "/velodyne/vlp16_ros2.db3", pcap);
  auto source = open("velodyne:" + pcap.write() + "?model=VLP-16");
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 4);
  const Sweep& sweep = sweeps.back();  // of the scan that the truth was made of

  std::ifstream file(*data + "/velodyne/vlp16_ros2_decoded.pcd", std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::uint8_t> scratch;
  const auto cloud =
      ingest::parse_pcd({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, scratch);
  REQUIRE(cloud.has_value());
  CHECK(std::abs(static_cast<int>(sweep.returns.size()) - static_cast<int>(cloud->points)) < 100);

  const auto truth = interpolated_points(*cloud);
  REQUIRE(truth.size() > cloud->points * 3 / 4);
  std::vector<double> distances;
  for (const Return& point : truth) distances.push_back(distance_to_nearest(sweep, point));
  std::sort(distances.begin(), distances.end());
  CHECK(distances[distances.size() / 2] < 0.001);
  CHECK(distances.back() < 0.01);  // 0.002 in fact
}
