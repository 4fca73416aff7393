// MCAP files as recorders write them, and as killed recorders and bad disks leave them.
#include <catch2/catch.hpp>
#include <fstream>

#include "services/common/mcap/mcap_reader.hpp"
#include "tests/support/mcap_builder.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using Octets = std::vector<std::uint8_t>;

namespace {

mcap::McapReader open(const std::string& path) {
  auto reader = mcap::McapReader::open(path);
  INFO((reader ? "" : reader.error()));
  REQUIRE(reader.has_value());
  return std::move(*reader);
}

/// Each message as "topic time first-byte".
std::vector<std::string> all(mcap::McapReader& reader) {
  std::vector<std::string> out;
  mcap::Message message;
  for (;;) {
    const auto more = reader.next(message);
    INFO((more ? "" : more.error()));
    REQUIRE(more.has_value());
    if (!*more) return out;
    REQUIRE(message.data.size == 3);
    out.push_back(message.channel->topic + " " + std::to_string(message.log_ns) + " " +
                  std::to_string(message.data.data[0]));
  }
}

Octets of(int value) {
  return Octets(3, static_cast<std::uint8_t>(value));
}

/// 12 messages of two topics, out of order within chunks and across them.
McapBuilder two_topics(const McapLayout& layout) {
  McapBuilder file(layout);
  const auto a = file.topic("/a", "pkg/msg/A");
  const auto b = file.topic("/b", "pkg/msg/B");
  for (const int i : {1, 0, 3, 2, 5, 8, 7, 4, 6, 9, 10, 11}) file.add(i % 2 == 0 ? a : b, 100 + i, of(i));
  return file;
}

std::vector<std::string> expected_of_two_topics() {
  std::vector<std::string> out;
  for (int i = 0; i < 12; ++i)
    out.push_back((i % 2 == 0 ? "/a " : "/b ") + std::to_string(100 + i) + " " + std::to_string(i));
  return out;
}

void overwrite(const std::string& path, std::uint64_t offset, const std::string& bytes) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(static_cast<std::streamoff>(offset));
  file << bytes;
}

bool any_contains(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(),
                     [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

}  // namespace

TEST_CASE("every layout gives the same messages in order of their log times, and again after rewind") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.mcap";
  for (const std::string compression : {"", "lz4", "zstd"})
    for (const std::size_t chunk : {0, 4, 100})
      for (const bool summary : {true, false})
        for (const bool crc : {true, false}) {
          if (chunk == 0 && !compression.empty()) continue;
          INFO(compression << " chunks of " << chunk << (summary ? " with" : " without") << " summary, crc "
                           << crc);
          two_topics({compression, chunk, summary, crc}).write(path);
          auto reader = open(path);
          CHECK(reader.first_ns() == 100);
          CHECK(reader.last_ns() == 111);
          CHECK(reader.channels().at(1).type == "pkg/msg/A");
          CHECK(reader.channels().at(2).messages == 6);
          CHECK(reader.channels().at(2).encoding == "cdr");
          CHECK(all(reader) == expected_of_two_topics());
          reader.rewind();
          CHECK(all(reader) == expected_of_two_topics());
          CHECK(reader.damaged() == 0);
          CHECK(reader.warnings().empty() == summary);
        }
}

TEST_CASE("only the selected channels come, and chunks without them are not even read") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.mcap";
  McapBuilder file({"zstd", 2});
  const auto a = file.topic("/a", "pkg/msg/A");
  const auto b = file.topic("/b", "pkg/msg/B");
  for (int i = 0; i < 4; ++i) file.add(a, i, of(i));
  for (int i = 4; i < 8; ++i) file.add(b, i, of(i));
  file.write(path);
  overwrite(path, file.chunk_offset(3) + 60, "damage!");  // of /b
  auto reader = open(path);
  reader.select({a});
  CHECK(all(reader) == std::vector<std::string>{"/a 0 0", "/a 1 1", "/a 2 2", "/a 3 3"});
  CHECK(reader.damaged() == 0);
  reader.select({b});
  CHECK(all(reader) == std::vector<std::string>{"/b 4 4", "/b 5 5"});
  CHECK(reader.damaged() == 1);
}

TEST_CASE("a killed recorder's file, cut anywhere, gives all whole chunks before the cut") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.mcap";
  McapBuilder whole({"zstd", 1});
  const auto a = whole.topic("/a", "pkg/msg/A");
  for (int i = 0; i < 5; ++i) whole.add(a, i, of(i));
  const std::size_t bytes = whole.bytes().size();
  for (std::size_t size = 8; size < bytes; size += 3) {
    INFO("cut to " << size << " of " << bytes);
    whole.write(path, size);
    std::size_t expected = 0;
    for (std::size_t i = 0; i < 5; ++i) expected += whole.chunk_offset(i) + whole.chunk_bytes(i) <= size;
    auto reader = open(path);
    CHECK(all(reader).size() == expected);
    CHECK(any_contains(reader.warnings(), "a.mcap: was not closed by its recorder"));
    if (size > whole.chunk_offset(2) && size < whole.chunk_offset(2) + whole.chunk_bytes(2)) {
      CHECK(any_contains(reader.warnings(),
                         "cut off, or damaged, at byte " + std::to_string(whole.chunk_offset(2))));
      CHECK(reader.damaged() == 1);
    }
  }
}

TEST_CASE("messages without chunks are all read up to the cut") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.mcap";
  McapBuilder file({"", 0, false});
  const auto a = file.topic("/a", "pkg/msg/A");
  for (int i = 0; i < 5; ++i) file.add(a, i, of(i));
  const std::size_t tail = 13 + 29 + 8;  // DataEnd, footer, magic
  file.write(path, file.bytes().size() - tail - 1);
  auto reader = open(path);
  CHECK(all(reader).size() == 4);
  CHECK(reader.damaged() == 1);
}

TEST_CASE("a damaged chunk is counted and named, and the others are read") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.mcap";
  for (const bool summary : {true, false})
    for (const std::string compression : {"", "lz4", "zstd"}) {
      INFO(compression << (summary ? " with" : " without") << " summary");
      auto file = two_topics({compression, 4, summary});
      file.write(path);
      overwrite(path, file.chunk_offset(1) + file.chunk_bytes(1) - 6, "XYZ");
      auto reader = open(path);
      CHECK(all(reader).size() == 8);
      CHECK(reader.damaged() == 1);
      CHECK(any_contains(reader.warnings(), "chunk at byte " + std::to_string(file.chunk_offset(1)) + ": "));
      reader.rewind();
      CHECK(all(reader).size() == 8);
      CHECK(reader.damaged() == 1);
    }
}

TEST_CASE("a summary that is damaged, or leads nowhere, is done without") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.mcap";
  auto file = two_topics({"zstd", 4});
  file.write(path);
  overwrite(path, file.bytes().size() - 8 - 29 - 40, "XYZ");  // its CRC is wrong now
  auto reader = open(path);
  CHECK(all(reader) == expected_of_two_topics());
  CHECK(any_contains(reader.warnings(), "has no summary that could be used"));
}

TEST_CASE("what is no MCAP file, and a chunk packed by something unknown, are said so") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.mcap";
  std::ofstream(path) << "SQLite format 3";
  CHECK(mcap::McapReader::open(path).error() == path + ": is no MCAP file");
  CHECK(mcap::McapReader::open(folder.path() + "/none").error() ==
        folder.path() + "/none: No such file or directory");
  auto file = two_topics({"zstd", 100});
  file.write(path);
  overwrite(path, file.chunk_offset(0) + 9 + 32, "zstX");
  auto reader = open(path);
  CHECK(all(reader).empty());
  CHECK(any_contains(reader.warnings(), "it is packed by 'zstX', which is not known"));
}

TEST_CASE("a chunk that says it unpacks to a petabyte is not believed") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.mcap";
  auto file = two_topics({"zstd", 100});
  file.write(path);
  overwrite(path, file.chunk_offset(0) + 9 + 16 + 5, "\x10");
  auto reader = open(path);
  CHECK(all(reader).empty());
  CHECK(any_contains(reader.warnings(), "it says that it unpacks to 1759"));
}
