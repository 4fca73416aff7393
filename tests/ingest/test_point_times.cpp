// The times of a .pcd's points: which field, in which unit, from which zero.
#include <cmath>
#include <filesystem>
#include <limits>

#include "tests/ingest/scan_builder.hpp"

using namespace gvom;
using namespace gvom::test;

namespace {

constexpr std::int64_t kSince1970Ns = 1'700'000'000'000'000'000;

/// `points` hits, whose times go from `first` on by `step`.
struct Cloud {
  std::string field = "t";
  char type = 'F';
  int size = 8;
  int points = 3000;
  double first = 0;
  double step = 0;

  [[nodiscard]] std::string write_to(const std::string& path) const {
    ByteVector body;
    for (int i = 0; i < points; ++i) {
      for (const float value : {1.F, 2.F, 3.F}) put_le(body, value);
      const double time = first + step * i;
      if (type == 'F' && size == 8) put_le(body, time);
      if (type == 'F' && size == 4) put_le(body, static_cast<float>(time));
      if (type == 'U' && size == 8) put_le(body, static_cast<std::uint64_t>(time));
      if (type == 'U' && size == 4) put_le(body, static_cast<std::uint32_t>(time));
      if (type == 'I' && size == 4) put_le(body, static_cast<std::int32_t>(time));
    }
    return write(path, joined(header("x y z " + field, "4 4 4 " + std::to_string(size),
                                     std::string("F F F ") + type, points, "binary"),
                              body));
  }
};

struct Read {
  std::int64_t first_ns = 0, span_ns = 0;
  std::vector<std::string> warnings;
};

/// Of one scan, whose stamp is 10 s.
Read read(const Cloud& cloud, const std::string& options = "") {
  TemporaryFolder folder;
  (void)cloud.write_to(folder.path() + "/a.pcd");
  write_text(folder.path() + "/times.txt", "10\n");
  const auto source = open("scans:" + folder.path() + options);
  const Sweep sweep = all_sweeps(*source).at(0);
  return {sweep.times_ns.front(), sweep.times_ns.back() - sweep.times_ns.front(), source->warnings()};
}

std::string error_of(const Cloud& cloud) {
  TemporaryFolder folder;
  return read_error(cloud.write_to(folder.path() + "/a.pcd"));
}

bool mentions(const std::vector<std::string>& warnings, const std::string& words) {
  for (const std::string& warning : warnings)
    if (warning.find(words) != std::string::npos) return true;
  return false;
}

constexpr double kStepS = 0.1 / 3000;
constexpr std::int64_t kSpanNs = 99'966'667;

}  // namespace

TEST_CASE("whole numbers are nanoseconds, floating-point ones seconds, without a word") {
  for (const char* field : {"t", "time", "Timestamp", "time_stamp", "time_offset", "offset_time"}) {
    INFO(field);
    const Read whole = read({field, 'U', 4, 3000, 5, kStepS * 1e9});
    CHECK(whole.first_ns == 10'000'000'005);
    CHECK(std::abs(whole.span_ns - kSpanNs) <= 1);
    CHECK(whole.warnings.empty());
  }
  const Read real = read({"time", 'F', 4, 3000, -0.1, kStepS});
  CHECK(std::abs(real.first_ns - 9'900'000'000) < 10);
  CHECK(std::abs(real.span_ns - kSpanNs) < 100);
  CHECK(real.warnings.empty());
}

TEST_CASE("a unit that alone fits is taken, with a warning") {
  struct Case {
    Cloud cloud;
    const char* unit;
    std::int64_t first_ns;
  };
  const auto since_1970 = static_cast<double>(kSince1970Ns);
  for (const Case& c : {Case{{"timestamp", 'F', 8, 3000, since_1970, kStepS * 1e9}, "ns", kSince1970Ns},
                        Case{{"timestamp", 'F', 8, 3000, since_1970 / 1e3, kStepS * 1e6}, "us", kSince1970Ns},
                        Case{{"timestamp", 'U', 8, 3000, since_1970 / 1e3, kStepS * 1e6}, "us", kSince1970Ns},
                        Case{{"timestamp", 'F', 8, 3000, since_1970 / 1e6, kStepS * 1e3}, "ms", kSince1970Ns},
                        Case{{"t", 'F', 4, 3000, 0, kStepS * 1e9}, "ns", 10'000'000'000},
                        Case{{"t", 'F', 8, 3, since_1970, kStepS * 1e9}, "ns", kSince1970Ns}}) {
    INFO(c.cloud.field << c.cloud.type << c.cloud.size << " " << c.cloud.first << " " << c.unit);
    const Read got = read(c.cloud);
    CHECK(std::abs(got.first_ns - c.first_ns) < 1000);
    CHECK(mentions(got.warnings, std::string("is taken as ") + c.unit));
    CHECK(mentions(got.warnings, "are a clock's") == (c.first_ns == kSince1970Ns));
    if (c.cloud.points >= 3000) CHECK(std::abs(got.span_ns - kSpanNs) < 50'000);
  }
}

TEST_CASE("nanoseconds that are too few for a sweep are used, and told of") {
  const Read within_packets = read({"t", 'U', 4, 30000, 0, kStepS * 1e5});
  CHECK(within_packets.span_ns < 100'000);
  CHECK(mentions(within_packets.warnings, "the 30000 points take only 0.000100 s by 't' in ns"));
}

TEST_CASE("seconds since 1970 and times from a sensor's boot are a clock's") {
  const Read since_1970 = read({"timestamp", 'F', 8, 3000, 1.7e9, kStepS});
  CHECK(since_1970.first_ns == kSince1970Ns);
  CHECK(mentions(since_1970.warnings, "are a clock's, and taken instead of the stamps"));
  CHECK(read({"t", 'U', 8, 3000, 991'587'364'520, kStepS * 1e9}).first_ns == 991'587'364'520);
}

TEST_CASE("where the unit remains open, or no unit fits, the scan is refused, and an option says it") {
  const Cloud few{"t", 'F', 8, 10, 0, 9000};  // us, or ns of a small piece
  CHECK(error_of(few).find("the unit of field 't' cannot be told: 10 points from 0.000000 to 81000") !=
        std::string::npos);
  CHECK(read(few, "?time=us").span_ns == 81'000'000);
  CHECK(read(few, "?time=none").span_ns == 0);
  CHECK(error_of({"t", 'F', 4, 3000, 0, kStepS * 1e6}).find("cannot be told") != std::string::npos);
  CHECK(error_of({"t", 'F', 8, 3000, 0, 1e9}).find("cannot be told") != std::string::npos);
  CHECK(error_of({"t", 'F', 4, 3000, 1.7e9, kStepS}).find("a clock's time in 4 bytes") != std::string::npos);
  CHECK(error_of({"t", 'U', 8, 1, 1.7e15, 0}).find("cannot be told") !=
        std::string::npos);  // us, or ns since boot
  CHECK(open_error("scans:/tmp?time=days").find("expected ns, us, ms, s or none") != std::string::npos);
}

TEST_CASE("later scans keep to unit and zero of the first, and go on in time") {
  TemporaryFolder folder;
  const auto error_after = [&](const Cloud& first, const Cloud& second) {
    (void)first.write_to(folder.path() + "/1.pcd");
    (void)second.write_to(folder.path() + "/2.pcd");
    auto source = open("scans:" + folder.path());
    Sweep sweep;
    REQUIRE(source->next(sweep, std::chrono::milliseconds(0)).has_value());
    const auto event = source->next(sweep, std::chrono::milliseconds(0));
    return event ? "no error" : event.error();
  };
  const Cloud relative{"t", 'F', 8, 3000, 0, kStepS}, clock{"t", 'F', 8, 3000, 1.7e9, kStepS};
  const Cloud earlier{"t", 'F', 8, 3000, 1.6e9, kStepS}, ns{"t", 'F', 8, 3000, 0, kStepS * 1e9};
  CHECK(error_after(relative, relative) == "no error");
  CHECK(error_after(relative, clock).find("count from another zero") != std::string::npos);
  CHECK(error_after(relative, ns).find("is not a time in s") != std::string::npos);
  CHECK(error_after(clock, earlier).find("time goes back") != std::string::npos);
}

TEST_CASE("fields that look like times and are not used are told of by name") {
  const Read unknown = read({"gps_time", 'F', 8, 3000, 0, kStepS});
  CHECK(unknown.span_ns == 0);
  CHECK(mentions(unknown.warnings,
                 "field 'gps_time' looks like a time and is not used: all points take the stamp"));
  for (const char* field : {"ts", "stamp", "nsec", "T_us", "GpsTime", "time_us", "offset_t", "seconds"})
    CHECK(mentions(read({field, 'U', 4, 10, 0, 1}).warnings,
                   std::string("field '") + field + "' looks like a time"));
  for (const char* field : {"intensity", "ring", "return_type", "tag", "azimuth", "distance", "reflectivity"})
    CHECK(read({field, 'U', 4, 10, 0, 1}).warnings.empty());
  TemporaryFolder folder;
  const std::string path =
      write_text(folder.path() + "/a.pcd",
                 header("x y z timestamp t", "4 4 4 8 4", "F F F F U", 1, "ascii") + "1 2 3 0.5 100\n");
  const auto source = open("scans:" + path);
  CHECK(all_sweeps(*source).at(0).times_ns == std::vector<std::int64_t>{100});
  CHECK(mentions(source->warnings(),
                 "field 'timestamp' looks like a time and is not used: the times are those of 't'"));
}

TEST_CASE("points that are no hits may have any time") {
  TemporaryFolder folder;
  const std::string path = write_text(
      folder.path() + "/a.pcd", header("x y z t", "4 4 4 8", "F F F F", 4, "ascii") +
                                    "nan nan nan 0\n1 2 3 1700000000.5\n1 2 3 1700000000.25\n0 0 0 nan\n");
  const Sweep sweep = only_sweep(path);
  CHECK(sweep.returns.size() == 4);
  CHECK(sweep.times_ns == std::vector<std::int64_t>{kSince1970Ns + 250'000'000, kSince1970Ns + 500'000'000});
  write_text(path, header("x y z t", "4 4 4 8", "F F F F", 1, "ascii") + "nan nan nan nan\n");
  CHECK(only_sweep(path).times_ns == std::vector<std::int64_t>{0});
}

TEST_CASE("times of clouds from the field") {
  const auto data = recordings();
  if (!data) return;
  const auto nebula = open("scans:" + *data + "/field/pcd_time_stamp_field/vlp16.pcd");
  const Sweep turn = all_sweeps(*nebula).at(0);
  CHECK(turn.returns.size() == 14831);
  CHECK(turn.times_ns.front() == 2303);  // they begin anew with each packet of 1.3 ms
  CHECK(turn.times_ns.back() == 1306368);
  CHECK(mentions(nebula->warnings(), "the 14831 points take only 0.001304 s by 'time_stamp' in ns"));
  const auto livox = open("scans:" + *data + "/field/pcd_livox_timestamp_ns/0.pcd");
  const Sweep sweep = all_sweeps(*livox).at(0);
  CHECK(sweep.stamp_ns > 1'600'000'000'000'000'000);
  CHECK(mentions(livox->warnings(), "field 'timestamp' is taken as ns"));
  const auto ouster = open("scans:" + *data + "/field/pcd_count0_padding/0.pcd");
  const Sweep padded = all_sweeps(*ouster).at(0);
  CHECK(padded.times_ns.back() - padded.times_ns.front() < 110'000'000);
  const auto forest = open("scans:" + *data + "/forest/marv_ouster.pcd");
  CHECK(all_sweeps(*forest).at(0).times_ns.size() > 500);
  CHECK(forest->warnings().size() == 1);  // no times.txt
}
