#include "tests/processes/observer.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include "ipc/brick_map.hpp"
#include "ipc/fixed.hpp"
#include "ipc/layers.hpp"
#include "ipc/pool_use.hpp"
#include "ipc/waiter.hpp"

namespace gvom::test {

using namespace std::chrono_literals;
using ipc::test::eventually;

namespace {

Voxel voxel_of(const ipc::BrickMapSample& map, std::size_t slot, std::int32_t brick, std::size_t cell) {
  const ipc::BrickMap& header = map.header();
  const auto per_row = static_cast<std::size_t>(header.grid.size[0] / 8);
  const auto per_floor = per_row * static_cast<std::size_t>(header.grid.size[1] / 8);
  const auto at = [&](int axis, std::size_t in_bricks, std::size_t in_brick) {
    return header.grid.origin[axis] + static_cast<std::int32_t>(in_bricks * 8 + in_brick);
  };
  Voxel voxel{at(0, slot % per_row, cell / 64),
              at(1, slot % per_floor / per_row, cell / 8 % 8),
              at(2, slot / per_floor, cell % 8),
              0,
              0,
              std::numeric_limits<float>::infinity()};
  const std::int32_t value = map.lookup()[static_cast<std::size_t>(brick) * 512 + cell];
  if (value < 0) {
    voxel.passes = static_cast<std::uint32_t>(-1 - value);
  } else {
    const VoxelRecord& record = map.records()[static_cast<std::size_t>(value)];
    voxel.hits = record.hits;
    voxel.passes = record.passes;
    voxel.min_height_m = record.min_height_m;
  }
  return voxel;
}

/// All or nothing for whoever reads at the same time.
void save(const std::vector<Voxel>& voxels, const std::string& path) {
  std::ofstream file(path + ".new", std::ios::binary);
  file.write(reinterpret_cast<const char*>(voxels.data()),
             static_cast<std::streamsize>(voxels.size() * sizeof(Voxel)));
  file.close();
  std::rename((path + ".new").c_str(), path.c_str());
}

}  // namespace

std::vector<Voxel> observed_voxels(const ipc::BrickMapSample& map) {
  std::vector<Voxel> voxels;
  for (std::size_t slot = 0; slot < map.header().shape.brick_slots; ++slot) {
    const std::int32_t brick = map.directory()[slot];
    for (std::size_t cell = 0; brick >= 0 && cell < 512; ++cell) {
      const Voxel voxel = voxel_of(map, slot, brick, cell);
      if (voxel.hits + voxel.passes > 0) voxels.push_back(voxel);
    }
  }
  std::sort(voxels.begin(), voxels.end(),
            [](const Voxel& a, const Voxel& b) { return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x); });
  return voxels;
}

Observer::Observer(const std::string& folder)
    : folder_(folder),
      board_(static_cast<Board*>(
          ::mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))),
      child_([this] {
        pthread_mutexattr_t shared;
        ::pthread_mutexattr_init(&shared);
        ::pthread_mutexattr_setpshared(&shared, PTHREAD_PROCESS_SHARED);
        ::pthread_mutex_init(&board_->mutex, &shared);
        watch();
      }) {
  up_ = up_step_.wait_for(1);
}

Observer::~Observer() {
  child_.kill();
  ::munmap(board_, sizeof(Board));
}

void Observer::watch() {
  auto runtime = ipc::Runtime::connect("observer", 5s).value();
  auto layers = ipc::LayersSubscriber::open(runtime).value();
  auto voxels = ipc::BrickMapSubscriber::voxel_map(runtime).value();
  auto health = ipc::Subscriber<ipc::Health>::open(runtime).value();
  auto pool_reports = ipc::PoolReports::open(runtime).value();
  auto waiter = ipc::Waiter::create(runtime);
  waiter.add(layers);
  waiter.add(voxels);
  waiter.add(health);
  up_step_.reach(1);
  while (true) {
    waiter.wait(100ms);
    if (const auto map = voxels.take()) save(observed_voxels(*map), folder_ + "/voxels");
    ::pthread_mutex_lock(&board_->mutex);
    while (const auto sample = health.take())
      note(**sample);  // first: then the layers that it counts are there
    while (const auto sample = layers.take()) {
      ++board_->layers;
      board_->newest = sample->header();
    }
    if (const auto pools = pool_reports.take()) {
      ++board_->pool_reports;
      board_->pools = static_cast<int>(std::min<std::size_t>(pools->size(), kMostPools));
      for (int i = 0; i < board_->pools; ++i)
        board_->used_chunks[i] = (*pools)[static_cast<std::size_t>(i)].used;
    }
    ::pthread_mutex_unlock(&board_->mutex);
  }
}

void Observer::note(const ipc::Health& health) {
  int i = 0;
  while (i < board_->processes && std::strcmp(board_->health[i].process, health.process) != 0) ++i;
  EXPECT(i < kMostProcesses);
  const std::string said = std::string(health.process) + ": " + health.reason + "\n";
  if (std::strcmp(board_->health[i].reason, health.reason) != 0 &&
      board_->said_size + said.size() < kMostSaid)
    board_->said_size += said.copy(board_->said + board_->said_size, said.size());
  board_->health[i] = health;
  board_->processes = std::max(board_->processes, i + 1);
}

template <class Read>
auto Observer::read(Read what) const {
  ::pthread_mutex_lock(&board_->mutex);
  const auto result = what(*board_);
  ::pthread_mutex_unlock(&board_->mutex);
  return result;
}

std::uint64_t Observer::layers() const {
  return read([](const Board& board) { return board.layers; });
}

ipc::Layers Observer::newest_layers() const {
  return read([](const Board& board) { return board.newest; });
}

std::optional<ipc::Health> Observer::health(const std::string& process) const {
  return read([&](const Board& board) -> std::optional<ipc::Health> {
    for (int i = 0; i < board.processes; ++i)
      if (process == board.health[i].process) return board.health[i];
    return std::nullopt;
  });
}

bool Observer::has_said(const std::string& process, const std::string& words) const {
  std::istringstream said(read([](const Board& board) { return std::string(board.said, board.said_size); }));
  for (std::string line; std::getline(said, line);)
    if (line.rfind(process + ": ", 0) == 0 && line.find(words, process.size()) != std::string::npos)
      return true;
  return false;
}

std::uint64_t Observer::counter(const std::string& process, const std::string& name) const {
  const auto told = health(process);
  for (std::uint32_t i = 0; told && i < told->counter_count; ++i)
    if (name == told->counters[i].name) return told->counters[i].value;
  return 0;
}

std::string Observer::drops(const std::string& process) const {
  const auto told = health(process);
  std::string text;
  for (std::uint32_t i = 0; told && i < told->counter_count; ++i) {
    const ipc::Health::Counter& counter = told->counters[i];
    if (std::strncmp(counter.name, "drop_", 5) == 0 && counter.value > 0)
      text += std::string(counter.name) + "=" + std::to_string(counter.value) + " ";
  }
  return text;
}

std::string Observer::backend(const std::string& process) const {
  const auto told = health(process);
  return told ? std::string(told->backend) + ": " + told->backend_details : "";
}

bool Observer::sees(const std::string& process, ipc::HealthState state) const {
  return eventually([&] {
    const auto told = health(process);
    return told && told->state == static_cast<std::uint32_t>(state);
  });
}

std::vector<std::uint32_t> Observer::used_chunks() const {
  const auto reports = [](const Board& board) { return board.pool_reports; };
  const std::uint64_t before = read(reports);
  eventually([&] { return read(reports) > before + 1; });
  return read([](const Board& board) {
    return std::vector<std::uint32_t>(board.used_chunks, board.used_chunks + board.pools);
  });
}

std::vector<Voxel> Observer::voxels() const {
  std::ifstream file(folder_ + "/voxels", std::ios::binary | std::ios::ate);
  if (!file) return {};
  std::vector<Voxel> voxels(static_cast<std::size_t>(file.tellg()) / sizeof(Voxel));
  file.seekg(0).read(reinterpret_cast<char*>(voxels.data()),
                     static_cast<std::streamsize>(voxels.size() * sizeof(Voxel)));
  return voxels;
}

}  // namespace gvom::test
