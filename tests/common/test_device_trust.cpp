// Whose device failed three times within a minute computes on the CPU: what is remembered, and for how long.
#include <catch2/catch.hpp>

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/open_backend.hpp"
#include "services/common/device_trust.hpp"
#include "tests/tools/temporary_folder.hpp"

namespace {

using namespace gvom;
using Catch::Contains;
using services::add_failure;
using services::BootMoment;
using services::DeviceTrust;
using services::recent_failures;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

BootMoment at_s(double since_boot_s, const std::string& boot_id = "this-boot") {
  return {boot_id, static_cast<std::int64_t>(since_boot_s * 1e9)};
}

/// A folder for one record.
struct Record {
  test::TemporaryFolder folder;
  std::string path = folder.path() + "/gvom-fusion.device-failures";

  void fail_at(std::initializer_list<double> since_boot_s) const {
    for (const double s : since_boot_s)
      REQUIRE(add_failure(path, at_s(s), "fault at " + std::to_string(int(s))));
  }
  /// Why the CPU stands in; empty if the device may be used.
  [[nodiscard]] std::string fallback(const BootMoment& now, Backend asked = Backend::automatic) const {
    return DeviceTrust(asked, path, now).fallback();
  }
  [[nodiscard]] std::string text() const {
    std::ostringstream all;
    all << std::ifstream(path).rdbuf();
    return all.str();
  }
  void write(const std::string& text) const { std::ofstream(path) << text; }
};

}  // namespace

TEST_CASE("three failures within a minute make auto take the CPU, and say what failed last") {
  const Record record;
  CHECK(record.fallback(at_s(1)).empty());
  record.fail_at({10, 20});
  CHECK(record.fallback(at_s(25)).empty());
  record.fail_at({30});
  CHECK(record.fallback(at_s(31)) ==
        "the GPU failed 3 times within a minute, so the CPU computes until a later start: fault at 30");
}

TEST_CASE("two failures, a pause of a minute and another one are three starts on the device") {
  const Record record;
  record.fail_at({10, 20, 81});
  CHECK(record.fallback(at_s(82)).empty());
  record.fail_at({90});
  CHECK(record.fallback(at_s(91)).empty());
}

TEST_CASE("a start a minute after the failures tries the device again, and three more are too many again") {
  const Record record;
  record.fail_at({10, 20, 30});
  CHECK_FALSE(record.fallback(at_s(69.9)).empty());
  CHECK(record.fallback(at_s(70)).empty());
  record.fail_at({75, 80, 85});
  CHECK_THAT(record.fallback(at_s(86)), Contains("failed 3 times"));
}

TEST_CASE("cuda never falls back, and what it did is not held against auto") {
  const Record record;
  record.fail_at({10, 20, 30});
  CHECK(record.fallback(at_s(31), Backend::cuda).empty());
  CHECK(record.fallback(at_s(31), Backend::cpu).empty());
  const std::string before = record.text();
  DeviceTrust(Backend::cuda, record.path, at_s(40)).note_failure({"a fault"}, at_s(41));
  CHECK(record.text() == before);
  DeviceTrust(Backend::automatic, record.path, at_s(40)).note_failure({"a fault"}, at_s(41));
  CHECK(recent_failures(record.path, at_s(42))->back().what == "a fault");
}

TEST_CASE("what is opened is what was asked for, or the CPU with its reason as details") {
  const Record record;
  const auto open = [](Backend which) {
    return DeviceExpected<OpenBackend<FusionBackend>>(
        {nullptr, which == Backend::cpu ? "cpu" : "cuda", "as configured"});
  };
  CHECK(DeviceTrust(Backend::automatic, record.path, at_s(1)).open(open)->name == "cuda");
  record.fail_at({10, 20, 30});
  const DeviceTrust lost(Backend::automatic, record.path, at_s(31));
  CHECK(lost.open(open)->name == "cpu");
  CHECK(lost.open(open)->details == lost.fallback());
  CHECK(DeviceTrust(Backend::cuda, record.path, at_s(31)).open(open)->name == "cuda");
  CHECK(DeviceTrust(Backend::cpu, record.path, at_s(31)).open(open)->details == "as configured");
}

TEST_CASE("failures of another boot count as none, whatever its clock said") {
  const Record record;
  record.fail_at({100, 110, 120});
  CHECK_FALSE(record.fallback(at_s(121)).empty());
  CHECK(record.fallback(at_s(121, "next-boot")).empty());
  CHECK(recent_failures(record.path, at_s(5, "next-boot"))->empty());
  REQUIRE(add_failure(record.path, at_s(6, "next-boot"), "a fault"));
  CHECK(recent_failures(record.path, at_s(7, "next-boot"))->size() == 1);
}

TEST_CASE("a damaged record counts as none, is told, and the next failure begins a new one") {
  const Record record;
  record.fail_at({10, 20, 30});
  const std::string good = record.text();
  const auto is_damaged = [&](const std::string& text) {
    record.write(text);
    INFO(text);
    const auto read = recent_failures(record.path, at_s(31));
    REQUIRE_FALSE(read);
    CHECK(read.error() == record.path + ": damaged");
    CHECK(record.fallback(at_s(31)).empty());
  };
  is_damaged("");
  is_damaged("\n");
  is_damaged("\xff\xfe garbage \x01\n");
  is_damaged(good.substr(0, good.size() - 1));
  is_damaged(good + "30000000000\n");
  is_damaged(good + "soon a fault\n");
  is_damaged(good + "-5 a fault\n");
  is_damaged(good + "99999999999999999999 a fault\n");
  is_damaged(good + "31000000001 is to come\n");
  is_damaged(good + std::string(100'000, 'x') + "\n");
  REQUIRE(add_failure(record.path, at_s(31), "a fault"));
  CHECK(recent_failures(record.path, at_s(31))->size() == 1);
}

TEST_CASE("a record stays small, on plain lines, and leaves nothing beside it") {
  const Record record;
  for (int i = 0; i < 50; ++i)
    REQUIRE(add_failure(record.path, at_s(10 + i * 0.1), "line\nline\t\x1b" + std::string(10'000, 'x')));
  const auto kept = recent_failures(record.path, at_s(20));
  REQUIRE(kept->size() == 3);
  CHECK(kept->back().since_boot_ns == at_s(14.9).since_boot_ns);
  CHECK_THAT(kept->back().what, Catch::StartsWith("line line  xxx"));
  CHECK(std::filesystem::file_size(record.path) < 4096);
  const auto files = std::filesystem::directory_iterator(record.folder.path());
  CHECK(std::distance(begin(files), end(files)) == 1);
}

TEST_CASE("where no record can be written or read, that is an error in words and the device is used") {
  const Record record;
  const std::string nowhere = record.folder.path() + "/missing/record";
  const auto added = add_failure(nowhere, at_s(1), "a fault");
  REQUIRE_FALSE(added);
  CHECK(added.error() == nowhere + ": No such file or directory");
  DeviceTrust(Backend::automatic, nowhere, at_s(1)).note_failure({"a fault"}, at_s(2));

  std::filesystem::create_directory(record.path);  // as whatever else may be in the way
  CHECK_FALSE(add_failure(record.path, at_s(1), "a fault"));
  CHECK_FALSE(recent_failures(record.path, at_s(2)));
  CHECK(record.fallback(at_s(2)).empty());
  const auto files = std::filesystem::directory_iterator(record.folder.path());
  CHECK(std::distance(begin(files), end(files)) == 1);
}

TEST_CASE("a link or a pipe in the record's place is not followed and nobody waits for it") {
  const Record record;
  const Record other;
  other.fail_at({10, 20, 30});
  std::filesystem::create_symlink(other.path, record.path);
  CHECK(record.fallback(at_s(31)).empty());
  const std::string before = other.text();
  REQUIRE(add_failure(record.path, at_s(31), "a fault"));
  CHECK(other.text() == before);
  std::filesystem::remove(record.path);
  REQUIRE(::mkfifo(record.path.c_str(), 0600) == 0);
  CHECK(recent_failures(record.path, at_s(31)).error() == record.path + ": not a file of this user");
}

TEST_CASE("this machine's moment goes on, and is of one boot") {
  const BootMoment earlier = BootMoment::now();
  const BootMoment later = BootMoment::now();
  CHECK_FALSE(earlier.boot_id.empty());
  CHECK(later.boot_id == earlier.boot_id);
  CHECK(later.since_boot_ns >= earlier.since_boot_ns);
  CHECK(earlier.since_boot_ns > kSecond_ns);
}
