// Bags as rosbag2 leaves them: of either storage, split, packed, and of recorders that were killed.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "services/common/bag/bag_folder.hpp"
#include "services/common/bag/bag_reader.hpp"
#include "services/common/ros/incoming.hpp"
#include "tests/support/db3_builder.hpp"
#include "tests/support/mcap_builder.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/ros_messages.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
namespace fs = std::filesystem;

namespace {

bag::BagReader open(const std::string& path, const std::vector<std::string>& topics = {}) {
  auto reader = bag::BagReader::open(path, topics);
  INFO((reader ? "" : reader.error()));
  REQUIRE(reader.has_value());
  return std::move(*reader);
}

std::string refusal(const std::string& path, const std::vector<std::string>& topics = {}) {
  const auto reader = bag::BagReader::open(path, topics);
  REQUIRE_FALSE(reader.has_value());
  return reader.error();
}

/// Each message as "topic time bytes", with the first byte behind the head.
std::vector<std::string> all(bag::BagReader& reader) {
  std::vector<std::string> out;
  bag::Message message;
  while (reader.next(message)) {
    REQUIRE(message.data.size == 5);
    out.push_back(message.topic->name + " " + std::to_string(message.log_ns) + " " +
                  std::to_string(message.data.data[4]));
  }
  return out;
}

Octets of(int value) {
  return CdrWriter().add(static_cast<std::uint8_t>(value)).bytes();
}

Octets packed(const Octets& octets) {
  Octets out(ZSTD_compressBound(octets.size()));
  out.resize(ZSTD_compress(out.data(), out.size(), octets.data(), octets.size(), 1));
  return out;
}

Octets read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_file(const std::string& path, const Octets& octets) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(octets.data()), static_cast<std::streamsize>(octets.size()));
}

/// /a at even times, /b at odd ones, from `first` up to before `end`.
void write_db3(const std::string& path, int first, int end) {
  Db3Builder file(path);
  const int b = file.topic("/b", "pkg/msg/B");
  const int a = file.topic("/a", "pkg/msg/A");
  for (int i = end - 1; i >= first; --i) file.add(i % 2 == 0 ? a : b, 100 + i, of(i));
}

void write_mcap(const std::string& path, int first, int end) {
  McapBuilder file({"lz4", 3});
  const auto a = file.topic("/a", "pkg/msg/A");
  const auto b = file.topic("/b", "pkg/msg/B");
  for (int i = first; i < end; ++i) file.add(i % 2 == 0 ? a : b, 100 + i, of(i));
  file.write(path);
}

std::vector<std::string> expected(int first, int end) {
  std::vector<std::string> out;
  for (int i = first; i < end; ++i)
    out.push_back((i % 2 == 0 ? "/a " : "/b ") + std::to_string(100 + i) + " " + std::to_string(i));
  return out;
}

void write_metadata(const std::string& folder, const std::vector<std::string>& files) {
  std::ofstream out(folder + "/metadata.yaml");
  out << "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n  "
         "relative_file_paths:\n";
  for (const std::string& file : files) out << "    - " << file << "\n";
  out << "  duration:\n    nanoseconds: 7\n  topics_with_message_count:\n    - topic_metadata:\n        "
         "name: /a\n";
}

}  // namespace

TEST_CASE("one file, a folder, split files, either storage: the same messages in order of time") {
  TemporaryFolder folder;
  const std::string& path = folder.path();
  SECTION("one db3") {
    write_db3(path + "/x_0.db3", 0, 10);
    auto file = open(path + "/x_0.db3");
    CHECK(all(file) == expected(0, 10));
    CHECK(file.warnings().empty());
    write_metadata(path, {"x_0.db3"});
  }
  SECTION("split db3, listed with the folder's name in front as old recorders do") {
    write_db3(path + "/x_0.db3", 0, 4);
    write_db3(path + "/x_1.db3", 4, 9);
    write_db3(path + "/x_10.db3", 9, 10);
    write_metadata(path, {"x/x_0.db3", "x/x_1.db3", "\"x/x_10.db3\""});
  }
  SECTION("split mcap that overlap in time") {
    write_mcap(path + "/x_0.mcap", 0, 10);
    fs::rename(path + "/x_0.mcap", path + "/whole");
    McapBuilder even({"zstd", 2});
    McapBuilder odd({"", 2});
    const auto a = even.topic("/a", "pkg/msg/A");
    const auto b = odd.topic("/b", "pkg/msg/B");
    for (int i = 0; i < 10; ++i) (i % 2 == 0 ? even : odd).add(i % 2 == 0 ? a : b, 100 + i, of(i));
    even.write(path + "/x_0.mcap");
    odd.write(path + "/x_1.mcap");
    write_metadata(path, {"x_0.mcap", "x_1.mcap"});
  }
  SECTION("FILE compression") {
    for (const std::string name : {"x_0.db3", "x_1.mcap"}) {
      name == "x_0.db3" ? write_db3(path + "/" + name, 0, 5) : write_mcap(path + "/" + name, 5, 10);
      write_file(path + "/" + name + ".zstd", packed(read_file(path + "/" + name)));
      fs::remove(path + "/" + name);
    }
    write_metadata(path, {"x_0.db3.zstd", "x_1.mcap.zstd"});
  }
  SECTION("MESSAGE compression") {
    Db3Builder file(path + "/x_0.db3");
    const int a = file.topic("/a", "pkg/msg/A");
    const int b = file.topic("/b", "pkg/msg/B");
    for (int i = 0; i < 10; ++i) file.add(i % 2 == 0 ? a : b, 100 + i, packed(of(i)));
    write_metadata(path, {"x_0.db3"});
  }
  auto reader = open(path);
  CHECK(reader.first_ns() == 100);
  CHECK(reader.last_ns() == 109);
  REQUIRE(reader.topics().size() == 2);
  CHECK(reader.topics()[0]->name == "/a");
  CHECK(reader.topics()[1]->type == "pkg/msg/B");
  CHECK(reader.topics()[1]->messages == 5);
  CHECK(all(reader) == expected(0, 10));
  reader.rewind();
  CHECK(all(reader) == expected(0, 10));
  CHECK(reader.warnings().empty());
  auto only_a = open(path, {"/a"});
  CHECK(all(only_a) == std::vector<std::string>{"/a 100 0", "/a 102 2", "/a 104 4", "/a 106 6", "/a 108 8"});
}

TEST_CASE("what FILE compression unpacks does not stay") {
  TemporaryFolder folder;
  TemporaryFolder temporary;
  write_db3(folder.path() + "/x.db3", 0, 3);
  write_file(folder.path() + "/y.db3.zstd", packed(read_file(folder.path() + "/x.db3")));
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("TMPDIR", temporary.path().c_str(), 1);
  auto reader = open(folder.path() + "/y.db3.zstd");
  CHECK(all(reader).size() == 3);
  CHECK(fs::is_empty(temporary.path()));
  kept.empty() ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", kept.c_str(), 1);
}

TEST_CASE("metadata that is missing or old is told, and all files are read") {
  TemporaryFolder folder;
  write_db3(folder.path() + "/x_0.db3", 0, 4);
  write_db3(folder.path() + "/x_1.db3", 4, 10);
  auto killed = open(folder.path());
  CHECK(all(killed) == expected(0, 10));
  REQUIRE(killed.warnings().size() == 1);
  CHECK(killed.warnings()[0].find("no metadata.yaml") != std::string::npos);

  write_metadata(folder.path(), {"x_0.db3", "x_2.db3"});
  auto old = open(folder.path());
  CHECK(all(old) == expected(0, 10));
  CHECK(old.warnings() ==
        std::vector<std::string>{folder.path() + ": metadata.yaml names x_2.db3, which is not there",
                                 folder.path() + ": x_1.db3 is not in metadata.yaml, and read too"});
}

TEST_CASE("a bag whose recorder was killed with a -wal beside it is read to its last message") {
  TemporaryFolder folder;
  TemporaryFolder copy;
  {
    Db3Builder file(folder.path() + "/x.db3");
    file.run("COMMIT");
    file.run("PRAGMA journal_mode=WAL");
    file.run("PRAGMA wal_autocheckpoint=0");
    file.run("BEGIN");
    const int a = file.topic("/a", "pkg/msg/A");
    for (int i = 0; i < 10; i += 2) file.add(a, 100 + i, of(i));
    file.run("COMMIT");
    for (const std::string name : {"x.db3", "x.db3-wal"})  // as they lie there at that moment
      fs::copy_file(folder.path() + "/" + name, copy.path() + "/" + name);
    file.run("BEGIN");
  }
  auto reader = open(copy.path() + "/x.db3");
  CHECK(all(reader).size() == 5);
}

TEST_CASE("a file that can't be read is left out by name, and the others are read") {
  TemporaryFolder folder;
  write_db3(folder.path() + "/x_0.db3", 0, 4);
  write_file(folder.path() + "/x_1.db3", {'n', 'o', 'n', 'e'});
  write_file(folder.path() + "/x_2.db3.zstd", {1, 2, 3, 4});
  write_metadata(folder.path(), {"x_0.db3", "x_1.db3", "x_2.db3.zstd"});
  auto reader = open(folder.path());
  CHECK(all(reader) == expected(0, 4));
  REQUIRE(reader.warnings().size() >= 2);
  CHECK(reader.damaged() >= 2);
  CHECK(reader.warnings()[0].find("x_1.db3: file is not a database: left out") != std::string::npos);
  CHECK(reader.warnings()[1].find("x_2.db3.zstd: ") != std::string::npos);
}

TEST_CASE("a database whose end is missing gives what comes before, and says what ended it") {
  TemporaryFolder folder;
  {
    Db3Builder file(folder.path() + "/x.db3");
    const int a = file.topic("/a", "pkg/msg/A");
    for (int i = 0; i < 200; ++i) file.add(a, 100 + i, Octets(1000, 1));
  }
  fs::resize_file(folder.path() + "/x.db3", fs::file_size(folder.path() + "/x.db3") / 2);
  auto reader = bag::BagReader::open(folder.path() + "/x.db3", {});
  if (!reader) {
    CHECK(reader.error().find("x.db3: ") != std::string::npos);
    return;
  }
  bag::Message message;
  int messages = 0;
  while (reader->next(message)) ++messages;
  CHECK(messages < 200);
  CHECK(reader->damaged() >= 1);
  CHECK_FALSE(reader->warnings().empty());
}

TEST_CASE("a packed message that is damaged is left out, counted once and named") {
  TemporaryFolder folder;
  {
    Db3Builder file(folder.path() + "/x.db3");
    const int a = file.topic("/a", "pkg/msg/A");
    Octets cut = packed(of(1));
    cut.pop_back();
    file.add(a, 100, packed(of(0)));
    file.add(a, 101, cut);
    file.add(a, 102, packed(of(2)));
  }
  auto reader = open(folder.path() + "/x.db3");
  for (int round = 0; round < 2; ++round) {
    CHECK(all(reader) == std::vector<std::string>{"/a 100 0", "/a 102 2"});
    CHECK(reader.damaged() == 1);
    CHECK(reader.warnings() ==
          std::vector<std::string>{folder.path() + "/x.db3: /a: message 2: zstd: cut off: left out"});
    reader.rewind();
  }
}

TEST_CASE("what is no bag, and a topic that a bag does not have, are refused with what there is") {
  TemporaryFolder folder;
  const std::string& path = folder.path();
  CHECK(refusal(path + "/none") == path + "/none: No such file or directory");
  CHECK(refusal(path) == path + ": is no bag: has neither .db3 nor .mcap files");
  write_file(path + "/a.bag", {1});
  CHECK(refusal(path) == path + ": is a bag of ROS 1: convert it first (rosbags-convert)");
  write_file(path + "/a.txt", {1});
  CHECK(refusal(path + "/a.txt").find("ends with neither .db3 nor .mcap") != std::string::npos);
  write_db3(path + "/x.db3", 0, 2);
  CHECK(refusal(path + "/x.db3", {"/c"}) ==
        path + "/x.db3: has no topic '/c'; it has: /a (pkg/msg/A), /b (pkg/msg/B)");
  sqlite3* other = nullptr;
  sqlite3_open((path + "/other.db3").c_str(), &other);
  sqlite3_exec(other, "CREATE TABLE t(x); CREATE VIEW messages AS SELECT 1; CREATE VIEW topics AS SELECT 1",
               nullptr, nullptr, nullptr);
  sqlite3_close(other);
  CHECK(refusal(path + "/other.db3") ==
        path + "/other.db3: is no rosbag2 file: has no tables topics and messages");
}

TEST_CASE("a metadata.yaml's files are found whatever stands around them") {
  CHECK(bag::listed_files(
            "a:\n  relative_file_paths:\n    - x_0.db3\n    - 'y.db3'\n  duration: 5\n    - z\n") ==
        std::vector<std::string>{"x_0.db3", "y.db3"});
  CHECK(bag::listed_files("").empty());
  CHECK(bag::listed_files("relative_file_paths:").empty());
}

TEST_CASE("a real bag: four scans of a VLP-16") {
  const auto data = recordings();
  if (!data) return;
  auto reader = open(*data + "/velodyne/vlp16_ros2.db3", {"/velodyne_packets"});
  bag::Message message;
  std::vector<std::size_t> packets;
  while (reader.next(message)) {
    ros::HeaderIn header;
    std::vector<ros::VelodynePacketIn> scan;
    REQUIRE(ros::read_velodyne_scan(message.data, header, scan).has_value());
    packets.push_back(scan.size());
  }
  CHECK(packets.size() == 4);
  for (const std::size_t count : packets) CHECK((count == 150 || count == 151));
}
