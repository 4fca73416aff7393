// MCAP files: what is written is there, whole, also when the disk is full or the process is gone.
#include <signal.h>
#include <sys/resource.h>

#include <catch2/catch.hpp>

#include "services/common/mcap/split_writer.hpp"
#include "tests/bridge/mcap_file.hpp"
#include "tests/tools/temporary_folder.hpp"

namespace {

using namespace gvom;
using mcap::Packing;
using Bytes = std::vector<std::uint8_t>;

const mcap::OutChannel kCloud = {"/a", "cdr", "pkg/msg/A", "uint8[] data\n", "- depth: 1\n"};
const mcap::OutChannel kWords = {"/words", "json", "", "", ""};

/// Bytes that do not pack, different for each seed.
Bytes noise(std::size_t size, std::uint32_t seed) {
  Bytes bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>((seed = seed * 1664525U + 1013904223U) >> 24);
  return bytes;
}

TEST_CASE("messages come back as they were written, packed or not") {
  const auto packing = GENERATE(Packing::none, Packing::zstd);
  const test::TemporaryFolder folder;
  const std::string path = folder.path() + "/a.mcap";
  auto writer = mcap::Writer::create(path, {packing, 1000});
  REQUIRE(writer);
  const auto cloud = writer->add_channel(kCloud);
  const auto words = writer->add_channel(kWords);
  const auto second = writer->add_channel({"/b", "cdr", "pkg/msg/A", "", ""});
  for (int i = 0; i < 20; ++i) {
    REQUIRE(writer->write(cloud, 1000 - i, noise(300, std::uint32_t(i))));
    REQUIRE(writer->write(words, 5, {'{', '}'}));
  }
  REQUIRE(writer->write(second, -7, {}));
  REQUIRE(writer->close());
  CHECK(!writer->write(cloud, 1, {}));

  const test::McapFile file = test::read_mcap(path);
  CHECK(file.profile == "ros2");
  CHECK(file.finished);
  CHECK(file.bytes_behind == 0);
  CHECK(file.counted == 41);
  REQUIRE(file.messages.size() == 41);
  CHECK(file.chunks > 3);
  CHECK(file.indexed_chunks == file.chunks);
  CHECK(file.messages[6].bytes == noise(300, 3));
  CHECK(file.messages[6].log_ns == 997);
  CHECK(file.messages[6].type == "pkg/msg/A");
  CHECK(file.messages[7].topic == "/words");
  CHECK(file.messages[40].log_ns == 0);
  CHECK(file.schemas == std::map<std::string, std::string>{{"pkg/msg/A", "uint8[] data\n"}});
  CHECK(file.metadata.at("/a") == "- depth: 1\n");
}

TEST_CASE("a file without messages is one") {
  const test::TemporaryFolder folder;
  auto writer = mcap::Writer::create(folder.path() + "/a.mcap");
  REQUIRE(writer);
  writer->add_channel(kCloud);
  REQUIRE(writer->close());
  const test::McapFile file = test::read_mcap(folder.path() + "/a.mcap");
  CHECK(file.finished);
  CHECK(file.counted == 0);
}

TEST_CASE("what was flushed is there without an end, as after a kill") {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() + "/a.mcap";
  auto writer = mcap::Writer::create(path);
  REQUIRE(writer);
  const auto cloud = writer->add_channel(kCloud);
  REQUIRE(writer->write(cloud, 1, noise(10, 1)));
  REQUIRE(writer->flush());
  REQUIRE(writer->write(cloud, 2, noise(10, 2)));
  const test::McapFile file = test::read_mcap(path);
  CHECK(!file.finished);
  REQUIRE(file.messages.size() == 1);
  CHECK(file.messages[0].bytes == noise(10, 1));
}

/// While it lives, no file of this process grows beyond so many bytes.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) {
    ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, SIG_DFL);
  }

 private:
  rlimit before_{};
};

TEST_CASE("a full disk is told with the file's name, and what was written stays whole") {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() + "/a.mcap";
  auto writer = mcap::Writer::create(path, {Packing::zstd, 1000});
  REQUIRE(writer);
  const auto cloud = writer->add_channel(kCloud);
  int written = 0;
  std::string error;
  {
    const FileLimit limit(10'000);
    for (; error.empty() && written < 100; ++written)
      if (const auto done = writer->write(cloud, written, noise(1000, std::uint32_t(written))); !done)
        error = done.error();
    --written;
    CHECK_THAT(error, Catch::Contains(path) && Catch::Contains("after"));
    CHECK(writer->write(cloud, 1, {}).error() == error);
    CHECK(writer->close().error() == error);
  }
  const test::McapFile file = test::read_mcap(path);
  REQUIRE(written > 3);
  REQUIRE(file.messages.size() == std::size_t(written));
  CHECK(file.bytes_behind == 0);
  for (int i = 0; i < written; ++i)
    CHECK(file.messages[std::size_t(i)].bytes == noise(1000, std::uint32_t(i)));
  if (file.finished) CHECK(file.counted == std::uint64_t(written));
}

TEST_CASE("a folder that is not there, and a device that is full, are named") {
  CHECK_THAT(mcap::Writer::create("/nowhere/a.mcap").error(), Catch::StartsWith("/nowhere/a.mcap: No such"));
  CHECK_THAT(mcap::Writer::create("/dev/full").error(), Catch::StartsWith("/dev/full: No space left"));
}

TEST_CASE("a recording is split by size, and each file stands alone") {
  const test::TemporaryFolder folder;
  mcap::SplitWriter writer(folder.path() + "/run", 20'000, {Packing::zstd, 4000});
  const auto cloud = writer.add_channel(kCloud);
  for (int i = 0; i < 50; ++i) REQUIRE(writer.write(cloud, i, noise(1000, std::uint32_t(i))));
  REQUIRE(writer.close());
  REQUIRE(writer.files() == 3);
  std::size_t messages = 0;
  for (const char* number : {"000", "001", "002"}) {
    const std::string path = folder.path() + "/run_" + number + ".mcap";
    const test::McapFile file = test::read_mcap(path);
    CHECK(file.finished);
    CHECK(std::filesystem::file_size(path) < 26'000);
    for (const test::McapMessage& message : file.messages) CHECK(message.log_ns == messages++);
  }
  CHECK(messages == 50);
}

}  // namespace
