// What went in and was not counted.
#include <catch2/catch.hpp>
#include <cstring>

#include "ipc/text.hpp"
#include "tools/endurance/ledger.hpp"
#include "tools/endurance/pauses.hpp"

using namespace gvom;
using namespace gvom::endurance;
using Catch::Matchers::Contains;

namespace {

/// An ingest that took 100 packets in 10 sweeps, one of which waited too long.
const tools::Counters kIngest{
    {"packets", 98}, {"drop_packet_kernel", 2}, {"sweeps_in", 10}, {"sweeps_mapped", 9}, {"drop_overrun", 1}};
const tools::Counters kFusion{{"maps_in", 9},
                              {"maps_fused", 8},
                              {"drop_map_too_old", 1},
                              {"maps_sharing_layers", 1},
                              {"layers_out", 7}};

Pause all_counted() {
  Pause pause;
  pause.packets = 100;
  pause.fusion_life = 1;
  pause.maps = 9;
  pause.layers = 7;
  return pause;
}

std::vector<std::string> defects_of(const tools::Counters& ingest, const tools::Counters& fusion,
                                    const Pause& pause) {
  Ledger ledger;
  for (int look = 0; look < 3; ++look) {
    ledger.look_at_ingest("ingest", ingest, pause);
    ledger.look_at_fusion("fusion", fusion, pause);
  }
  return ledger.defects();
}

tools::Counters with(tools::Counters counters, const std::string& name, std::uint64_t value) {
  for (auto& [counter, known] : counters)
    if (counter == name) known = value;
  return counters;
}

}  // namespace

TEST_CASE("what was counted as dropped is not lost") {
  CHECK(defects_of(kIngest, kFusion, all_counted()).empty());
}

TEST_CASE("one packet, sweep, map or layers that nobody counted is a defect") {
  const auto defect_of = [](const tools::Counters& ingest, const tools::Counters& fusion,
                            const Pause& pause) {
    const auto defects = defects_of(ingest, fusion, pause);
    REQUIRE(!defects.empty());
    return defects.front();
  };
  Pause pause = all_counted();
  ++pause.packets;
  CHECK_THAT(defect_of(kIngest, kFusion, pause), Contains("packets sent and not counted: 1"));
  pause = all_counted();
  --pause.maps;
  CHECK_THAT(defect_of(kIngest, kFusion, pause), Contains("fusion 1 neither took nor missed: 1"));
  pause = all_counted();
  --pause.layers;
  CHECK_THAT(defect_of(kIngest, kFusion, pause), Contains("layers made and never numbered: 1"));
  CHECK_THAT(defect_of(with(kIngest, "sweeps_in", 11), kFusion, all_counted()),
             Contains("sweeps neither mapped nor counted as dropped: 1"));
  CHECK_THAT(defect_of(kIngest, with(kFusion, "maps_in", 10), all_counted()),
             Contains("maps neither fused nor counted as dropped: 1"));
}

TEST_CASE("what was still under way at one look is not lost") {
  Balance balance;
  for (const int under_way : {0, 3, 0, 1, 2}) balance.look(under_way);
  CHECK(balance.uncounted() == 0);
  balance.look(4);
  CHECK(balance.uncounted() == 1);  // three looks, and never less than one
}

TEST_CASE("a process that began in the middle is judged from there on") {
  Balance balance(false);
  for (int i = 0; i < 3; ++i) balance.look(640);
  CHECK(balance.uncounted() == 0);
  for (int i = 0; i < 3; ++i) balance.look(641);
  CHECK(balance.uncounted() == 1);
}

TEST_CASE("where it began is not told by one look that came in between") {
  Balance balance(false);
  for (const int difference : {640, 639, 640, 640, 640, 640}) balance.look(difference);
  CHECK(balance.uncounted() == 0);
}

TEST_CASE("only what was told in a pause is looked at") {
  Ledger ledger;
  Pauses pauses({"front"}, ledger);
  pauses.note_first("gvom-ingest-front", 7);
  ipc::Health health{};
  ipc::set_text(health.process, "gvom-ingest-front");
  health.pid = 7;
  RoundNote round{};
  round.mono_ns = 1'000'000'000;
  round.sent[0] = 5;
  health.mono_ns = 500'000'000;
  pauses.take(health);  // packets come
  pauses.begin(round);
  health.mono_ns = 1'050'000'000;
  pauses.take(health);  // the last ones are under way
  health.mono_ns = 1'400'000'000;
  pauses.take(health);  // a new round has begun, as it turns out
  pauses.end(1'350'000'000);
  CHECK(ledger.looks() == 0);
  for (int i = 0; i < 2; ++i) {
    pauses.begin(round);
    pauses.take(health);
    pauses.end(1'500'000'000);
  }
  CHECK(ledger.looks() == 4);  // packets and sweeps; no layers were heard
  CHECK_THAT(ledger.defects().at(0), Contains("gvom-ingest-front (7): packets sent and not counted: 5"));
}
