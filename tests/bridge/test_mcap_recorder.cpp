// The recorder: what it is offered is in its files; a folder that cannot be written is told.
#include <fcntl.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <set>

#include "services/bridge/mcap_recorder.hpp"
#include "services/common/bridge_config.hpp"
#include "tests/bridge/mcap_file.hpp"
#include "tests/bridge/ws_client.hpp"
#include "tests/tools/temporary_folder.hpp"

namespace {

using namespace gvom;
using bridge::McapRecorder;
using bridge::TopicId;

ros::Blob blob(std::size_t size, std::uint8_t value) {
  return std::make_shared<std::vector<std::uint8_t>>(size, value);
}

std::vector<std::string> files_in(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

TEST_CASE(
    "what is recorded unless it is said otherwise is all of ROS: ros2 bag opens no file with JSON in it") {
  const std::string topics = "," + bridge::McapConfig{}.topics + ",";
  for (const bridge::Topic& topic : bridge::kTopics) {
    const bool is_in = topics.find("," + std::string(topic.name) + ",") != std::string::npos;
    CAPTURE(topic.name);
    CHECK_FALSE((is_in && topic.type == nullptr));
  }
}

TEST_CASE("the topics that are asked for are recorded, with schema and quality of service") {
  const test::TemporaryFolder folder;
  bridge::RecorderOptions options;
  options.folder = folder.path() + "/new/one";
  options.topics = {TopicId::costmap, TopicId::status};
  {
    McapRecorder recorder(options);
    CHECK(recorder.wants(bridge::topic(TopicId::costmap)));
    CHECK(!recorder.wants(bridge::topic(TopicId::layers)));
    recorder.offer(bridge::topic(TopicId::status), 0, blob(2, '0'));  // before the first data
    for (std::uint8_t i = 1; i <= 10; ++i) {
      recorder.offer(bridge::topic(TopicId::costmap), i, blob(1000, i));
      recorder.offer(bridge::topic(TopicId::status), i, blob(2, '1'));
    }
    CHECK(test::eventually([&] { return recorder.counters().sent == 20; }));
    CHECK(recorder.counters().bytes == 10 * 1002);
    CHECK(recorder.problem().empty());
  }
  const auto files = files_in(options.folder);
  REQUIRE(files.size() == 1);
  const test::McapFile file = test::read_mcap(files[0]);
  CHECK(file.finished);
  REQUIRE(file.messages.size() == 20);
  CHECK(file.messages[18].topic == "/gvom/costmap");
  CHECK(file.messages[18].bytes == *blob(1000, 10));
  CHECK(file.messages[19].type.empty());
  CHECK_THAT(file.schemas.at("nav_msgs/msg/OccupancyGrid"), Catch::Contains("MSG: geometry_msgs/Pose\n"));
  CHECK_THAT(file.metadata.at("/gvom/costmap"), Catch::Contains("durability: 1\n"));
}

TEST_CASE("a recording of the same second, as after a reboot without a clock, is not written over") {
  const test::TemporaryFolder folder;
  bridge::RecorderOptions options;
  options.folder = folder.path();
  options.topics = {TopicId::costmap};
  constexpr std::size_t kRecordings = 10;  // in a few milliseconds
  for (std::uint8_t i = 1; i <= kRecordings; ++i) {
    McapRecorder recorder(options);
    recorder.offer(bridge::topic(TopicId::costmap), i, blob(10, i));
  }
  std::set<std::uint8_t> recorded;
  for (const std::string& file : files_in(options.folder))
    for (const test::McapMessage& message : test::read_mcap(file).messages) recorded.insert(message.bytes[0]);
  CHECK(recorded.size() == kRecordings);
}

TEST_CASE("what a slow disk leaves no room for is dropped and counted") {
  const test::TemporaryFolder folder;
  bridge::RecorderOptions options;
  options.folder = folder.path();
  options.topics = {TopicId::layers};
  options.most_waiting_bytes = 1000;
  McapRecorder recorder(options);
  recorder.offer(bridge::topic(TopicId::layers), 1, blob(1001, 0));
  CHECK(recorder.counters().dropped == 1);
  recorder.offer(bridge::topic(TopicId::layers), 1, blob(1000, 0));
  CHECK(test::eventually([&] { return recorder.counters().sent == 1; }));
}

TEST_CASE("a file that cannot be written ends the recording, in words") {
  bridge::RecorderOptions options;
  options.folder = "/proc/nowhere";
  options.topics = {TopicId::layers};
  McapRecorder recorder(options);
  CHECK_THAT(recorder.problem(), Catch::Contains("/proc/nowhere") && Catch::Contains("bridge.mcap.folder"));
  CHECK(!recorder.wants(bridge::topic(TopicId::layers)));
  recorder.offer(bridge::topic(TopicId::layers), 1, blob(1, 0));
  CHECK(recorder.counters().dropped == 1);
}

TEST_CASE("the recording ends before the disk is full, and says so") {
  const test::TemporaryFolder folder;
  bridge::RecorderOptions options;
  options.folder = folder.path();
  options.topics = {TopicId::layers};
  // Wide margins: others write and free meanwhile.
  options.min_free_bytes = std::filesystem::space(options.folder).available - 300'000'000;
  McapRecorder recorder(options);
  CHECK(recorder.wants(bridge::topic(TopicId::layers)));
  const int others = ::open((folder.path() + "/others").c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600);
  REQUIRE(::posix_fallocate(others, 0, 900'000'000) == 0);
  CHECK(::close(others) == 0);
  REQUIRE(test::eventually([&] { return !recorder.problem().empty(); }));
  CHECK_THAT(recorder.problem(),
             Catch::Contains(folder.path()) && Catch::Contains("bridge.mcap.min_free_mb"));
  CHECK(!recorder.wants(bridge::topic(TopicId::layers)));
  CHECK_THAT(McapRecorder(options).problem(), Catch::Contains("bridge.mcap.min_free_mb"));  // from the start
}

TEST_CASE("a folder that is taken away ends the recording when the next file is made") {
  const test::TemporaryFolder folder;
  bridge::RecorderOptions options;
  options.folder = folder.path() + "/gone";
  options.topics = {TopicId::layers};
  McapRecorder recorder(options);
  std::filesystem::remove_all(options.folder);
  recorder.offer(bridge::topic(TopicId::layers), 1, blob(1, 0));
  REQUIRE(test::eventually([&] { return !recorder.problem().empty(); }));
  CHECK_THAT(recorder.problem(), Catch::Contains("_000.mcap: No such file") && Catch::Contains("restart"));
  CHECK(!recorder.wants(bridge::topic(TopicId::layers)));
}

}  // namespace
