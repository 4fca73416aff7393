// The table of what an ingest counts.
#include <catch2/catch.hpp>

#include <set>

#include "services/ingest/ingest_counters.hpp"

using namespace gvom::ingest;

TEST_CASE("every counter is in Health, but those that say more about others") {
  IngestCounts counts;
  std::set<const void*> told;
  for (const CounterRow& row : kIngestCounters) told.insert(&(counts.*row.value));
  CHECK(told.size() == std::size(kIngestCounters));
  for (const void* more :
       {static_cast<const void*>(&counts.fragments), static_cast<const void*>(&counts.columns),
        static_cast<const void*>(&counts.dropped_fractions),
        static_cast<const void*>(&counts.best_dropped_fraction),
        static_cast<const void*>(&counts.foreign_size_changes),
        static_cast<const void*>(&counts.foreign_size), static_cast<const void*>(&counts.side_packets)})
    told.insert(more);
  const std::size_t texts =
      2 * sizeof counts.second_address + 2 * sizeof(gvom::ingest::KindText) + sizeof counts.refusal;
  const std::size_t all = sizeof counts - texts;
  CHECK(told.size() * sizeof(std::uint64_t) == all);
}

TEST_CASE("what was dropped is told in words, with what the source counted") {
  gvom::services::HealthReport health("ingest", 0);
  IngestCounters counters(health);
  CHECK(counters.dropped().empty());
  SourceCounters source;
  source.packets = 100;
  source.late_packets = 3;
  counters.take(source, {});
  counters.before_odometry = 12;
  counters.report();
  CHECK(counters.dropped() == "12 sweeps from before the first pose, 3 packets of a sweep that is closed");
  const auto& message = health.take(1);
  REQUIRE(message.counter_count == std::size(kIngestCounters));
  for (std::uint32_t i = 0; i < message.counter_count; ++i) {
    const std::string name = message.counters[i].name;
    CHECK(name == kIngestCounters[i].name);
    CHECK(message.counters[i].value == (name == "packets"                ? 100
                                        : name == "drop_packet_late"     ? 3
                                        : name == "drop_before_odometry" ? 12
                                                                         : 0));
  }
}
