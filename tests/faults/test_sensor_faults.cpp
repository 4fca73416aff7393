// A live sensor that fails: Health says how, and the good one next to it does not notice.
#include <catch2/catch.hpp>

#include "tests/faults/lab.hpp"

using namespace gvom::test;
using gvom::ipc::test::eventually;
using namespace std::chrono_literals;

namespace {

constexpr char kFront[] = "gvom-ingest-front";
constexpr char kRear[] = "gvom-ingest-rear";

struct Fault {
  const char* name;
  SensorMode mode;
  const char* words;
};

const Fault kFaults[] = {
    {"a sensor falls silent", SensorMode::silent, "no packets for"},
    {"30 % of packets are lost", SensorMode::loss, "% of packets lost"},
    {"every packet comes twice", SensorMode::duplicates, "% of packets came again"},
    {"packets change places", SensorMode::disorder, "% of packets out of order"},
    {"a second sensor on the port", SensorMode::second_sensor, "packets of a second sensor at 127.0.0.2"},
    {"a second sensor at the same address", SensorMode::second_serial,
     "packets of a second sensor at 127.0.0.1"},
    {"garbage on the port", SensorMode::garbage, "garbage"},
    {"a flood, ten times the packets", SensorMode::flood, "flood"},
    {"another model's packets", SensorMode::other_model, "packets of another model, 304 bytes each"},
};

}  // namespace

TEST_CASE("each fault of a sensor is told, costs its own sweeps only, and memory stays bounded") {
  Lab lab;
  const auto memory_before = resident_bytes(lab.graph->ingest("front").pid());
  const int descriptors_before = descriptors(lab.graph->ingest("front").pid());
  for (int round = 0; round < repeats(1); ++round) {
    for (const Fault& fault : kFaults) {
      lab.check_fault(
          fault.name, kFront, fault.words, [&] { lab.board->front = fault.mode; },
          [&] { lab.board->front = SensorMode::well; });
      CHECK(lab.graph->ingest("front").runs());
    }
  }
  CHECK(lab.board->wrong_maps == 0);
  CHECK(eventually([&] { return lab.is_ok(kRear); }));
  CHECK(lab.drops_besides(kRear, "drop_overrun") == "");
  CHECK(lab.observer->counter(kRear, "sweep_incomplete") == 0);
  // Its queues hold the maps of a second and a half: fusion may pause, but not lag behind.
  CHECK(4 * lab.observer->counter("gvom-fusion", "maps_lost") <
        lab.observer->counter("gvom-fusion", "maps_fused"));
  CHECK(resident_bytes(lab.graph->ingest("front").pid()) < memory_before + (4 << 20));
  CHECK(descriptors(lab.graph->ingest("front").pid()) == descriptors_before);
  lab.stop();
}

TEST_CASE("a sensor that falls silent is missing, and one that takes its place is taken up") {
  Lab lab;
  lab.board->front = SensorMode::second_sensor;
  CHECK(lab.layers_flow(20));
  CHECK(lab.board->wrong_maps == 0);
  lab.board->front = SensorMode::silent;
  CHECK(eventually([&] {
    const auto layers = lab.observer->newest_layers();
    return layers.lidars[0].missing == 1 && layers.lidars[1].missing == 0;
  }));
  lab.board->front = SensorMode::second_alone;
  CHECK(eventually([&] { return lab.observer->newest_layers().lidars[0].missing == 0; }));
  CHECK(eventually([&] { return lab.board->farthest_m > 15; }));
  CHECK(eventually([&] { return lab.is_ok(kFront); }));
  lab.stop();
}
