// Times in text: to the nanosecond, and dates by the calendar.
#include <catch2/catch.hpp>

#include "services/common/stamps.hpp"
#include "tests/common/temporary_file.hpp"

using namespace gvom;
using services::parse_date_ns;
using services::parse_stamp_ns;
using services::stamp_text;

TEST_CASE("stamps are exact to the nanosecond, where a double is not") {
  CHECK(parse_stamp_ns("1311868163.869999886") == 1311868163869999886);
  CHECK(parse_stamp_ns("1.311868163869999886e+09") == 1311868163869999886);
  CHECK(parse_stamp_ns("991.58736452") == 991587364520);
  CHECK(parse_stamp_ns("0") == 0);
  CHECK(parse_stamp_ns("0.0000000005") == 1);  // half away from zero
  CHECK(parse_stamp_ns("0.00000000049") == 0);
  CHECK(parse_stamp_ns("1e-9") == 1);
  CHECK(parse_stamp_ns("1e-10") == 0);
  CHECK(parse_stamp_ns("1e-30") == 0);
  CHECK(parse_stamp_ns("-1.5") == -1500000000);
  CHECK(parse_stamp_ns("+7.") == 7000000000);
  CHECK(parse_stamp_ns(".5") == 500000000);
  CHECK(parse_stamp_ns("9223372036.854775807") == INT64_MAX);
}

TEST_CASE("what is no stamp is none") {
  for (const char* text : {"", "-", ".", "e5", "1e", "nan", "inf", "1.2.3", "0x10", "1,5", "1e99999", "1e5x",
                           "1e5000", "9223372036.854775808", "99999999999", "1.5e-2147483648"}) {
    INFO(text);
    CHECK_FALSE(parse_stamp_ns(text));
  }
}

TEST_CASE("dates are nanoseconds since 1970, UTC") {
  CHECK(parse_date_ns("1970-01-01 00:00:00") == 0);
  CHECK(parse_date_ns("2011-09-26 13:02:25.594360375") ==
        1317042145594360375);  // date -u +%s says 1317042145
  CHECK(parse_date_ns("2011-09-26T13:02:25.5Z") == 1317042145500000000);
  CHECK(parse_date_ns("2012-02-29 23:59:59") == 1330559999000000000);
}

TEST_CASE("what is no date is none") {
  for (const char* text :
       {"", "2011-09-26", "2011-09-26 13:02", "2011-09-26 13:02:25.", "2011-13-26 13:02:25",
        "2011-02-29 13:02:25", "2011-09-26 24:02:25", "2011-09-26 13:02:61", "11-09-26 13:02:25",
        "2011-09-26 13:02:25.5 ", "2011-09-26 13:02:25.5e3", "2011-09-26 13:02:25x", "1969-12-31 23:59:59",
        "2262-01-01 00:00:00", "2011/09/26 13:02:25"}) {
    INFO(text);
    CHECK_FALSE(parse_date_ns(text));
  }
}

TEST_CASE("a file of times: seconds or dates, with the lines they are in") {
  const test::TemporaryFile file("\xEF\xBB\xBF# start\r\n1.5\r\n\r\n2011-09-26 13:02:25.5\r\n");
  const auto stamps = services::read_stamps(file.path());
  REQUIRE(stamps);
  REQUIRE(stamps->size() == 2);
  CHECK((*stamps)[0].stamp_ns == 1'500'000'000);
  CHECK((*stamps)[0].line == 2);
  CHECK((*stamps)[1].stamp_ns == 1317042145500000000);
  CHECK((*stamps)[1].line == 4);
  const test::TemporaryFile bad("1\nlater\n");
  CHECK(services::read_stamps(bad.path()).error().find(bad.path() + ":2: 'later' is not a time") == 0);
}

TEST_CASE("a stamp in words is decimal seconds, exactly") {
  CHECK(stamp_text(999'900'000'000) == "999.9");
  CHECK(stamp_text(-1) == "-0.000000001");
  CHECK(stamp_text(5'000'000'000) == "5");
  CHECK(stamp_text(INT64_MIN) == "-9223372036.854775808");
}
