// Rounds: which are clean, and whether their layers are the same.
#include <catch2/catch.hpp>

#include "tools/endurance/checksum.hpp"
#include "tools/endurance/rounds.hpp"

using namespace gvom::endurance;
using Catch::Matchers::Contains;

namespace {

constexpr std::int64_t kRound_ns = 10'000'000'000;

/// Rounds of one lidar with four sweeps, each making layers.
struct Book {
  RoundBook rounds{{4}};
  std::uint64_t sequence = 0;
  std::uint64_t maps = 0;

  static std::int64_t begin_ns(int round) { return (round + 1) * kRound_ns; }

  void play(int round, std::uint64_t salt = 0, int sweeps = 4) {
    const auto epoch = static_cast<std::uint64_t>(begin_ns(round));
    rounds.begin(epoch);
    for (int i = 0; i < sweeps; ++i) {
      LayersNote note{};
      note.epoch = epoch;
      note.sequence = ++sequence;
      note.maps[0] = ++maps;
      note.key = static_cast<std::uint64_t>(i);
      note.checksum = 100 + static_cast<std::uint64_t>(i) + (i == 2 ? salt : 0);
      rounds.add(note);
    }
    rounds.end(epoch, begin_ns(round) + 9'000'000'000);
  }
  void settle() { rounds.settle(begin_ns(1000)); }
};

}  // namespace

TEST_CASE("the layers of each round are compared with those of the first") {
  Book book;
  for (int round = 0; round < 5; ++round) book.play(round);
  book.settle();
  CHECK(book.rounds.rounds() == 5);
  CHECK(book.rounds.clean() == 5);
  CHECK(book.rounds.keys() == 4);
  CHECK(book.rounds.compared() == 16);
  CHECK(book.rounds.defect_count() == 0);
}

TEST_CASE("one other byte in one of a round's layers is a defect") {
  Book book;
  for (int round = 0; round < 3; ++round) book.play(round, round == 1 ? 1 : 0);
  book.settle();
  CHECK(book.rounds.wrong() == 1);
  REQUIRE(book.rounds.defects().size() == 1);
  CHECK_THAT(book.rounds.defects()[0], Contains("round 2") && Contains("other bytes"));
}

TEST_CASE("a round in which something was counted as lost is not compared, and says why") {
  Book book;
  book.play(0);
  book.play(1, 7);
  book.play(2);
  book.rounds.disturb(Book::begin_ns(1) + 100, Book::begin_ns(1) + 200, "fusion maps_lost");
  book.settle();
  CHECK(book.rounds.clean() == 2);
  CHECK(book.rounds.wrong() == 0);
  CHECK(book.rounds.disturbances().at("fusion maps_lost") == 1);
}

TEST_CASE("what is only found by the next Health disturbs both rounds that it reaches into") {
  Book book;
  for (int round = 0; round < 3; ++round) book.play(round);
  book.rounds.disturb(Book::begin_ns(1) - 1, Book::begin_ns(1) + 1, "x");
  book.settle();
  CHECK(book.rounds.clean() == 1);
}

TEST_CASE("a map that is missing in a clean round is a defect") {
  Book book;
  book.play(0);
  book.play(1, 0, 3);
  book.play(2);
  book.settle();
  REQUIRE(book.rounds.defects().size() == 1);
  CHECK_THAT(book.rounds.defects()[0], Contains("made 3 maps of 4 sweeps"));
}

TEST_CASE("a round is judged only when every process has told its counters") {
  Book book;
  book.play(0);
  book.play(1);
  book.rounds.settle(Book::begin_ns(1) + 2'900'000'000);
  CHECK(book.rounds.rounds() == 0);
  book.rounds.settle(Book::begin_ns(1) + 3'000'000'000);
  CHECK(book.rounds.rounds() == 1);
}

TEST_CASE("a round cut short is not clean") {
  Book book;
  book.rounds.begin(static_cast<std::uint64_t>(Book::begin_ns(0)));
  book.play(1);
  book.settle();
  CHECK(book.rounds.rounds() == 2);
  CHECK(book.rounds.clean() == 1);
}

TEST_CASE("a checksum tells one changed bit anywhere, and the order of words") {
  std::vector<std::uint8_t> bytes(1001, 3);
  const auto sum_of = [&] {
    Checksum sum;
    sum.add(bytes.data(), bytes.size());
    return sum.value();
  };
  const std::uint64_t sum = sum_of();
  CHECK(sum_of() == sum);
  for (const std::size_t at : {0u, 7u, 8u, 40u, 991u, 992u, 1000u}) {
    bytes[at] ^= 0x80;
    CHECK(sum_of() != sum);
    bytes[at] ^= 0x80;
  }
  bytes[1] = 9;
  const std::uint64_t first = sum_of();
  std::swap(bytes[1], bytes[33]);
  CHECK(sum_of() != first);
}
