#include "tests/processes/layers_log.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ipc/layers.hpp"
#include "ipc/text.hpp"
#include "ipc/waiter.hpp"

namespace gvom::test {

using namespace std::chrono_literals;

namespace {

constexpr std::uint32_t kQueue = 64;  // so that what does not come was not published

}  // namespace

std::int64_t LoggedLayers::seen_ns(std::size_t column) const {
  return header.header.stamp_ns - std::llround(double{last_seen_s[column]} * 1e9);
}

const ipc::LidarStatus& LoggedLayers::lidar(const char* name) const {
  for (std::uint32_t i = 0; i < header.lidar_count; ++i)
    if (ipc::text_of(header.lidars[i].name) == name) return header.lidars[i];
  throw std::out_of_range(name);
}

LayersLog::LayersLog()
    : pages_(static_cast<Pages*>(
          ::mmap(nullptr, sizeof(Pages), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))),
      child_([this] { write(); }) {
  up_ = up_step_.wait_for(1);
}

LayersLog::~LayersLog() {
  child_.kill();
  ::munmap(pages_, sizeof(Pages));
}

void LayersLog::write() {
  auto runtime = ipc::Runtime::connect("layers-log", 5s).value();
  ipc::Topic topic = ipc::layers_topic();
  topic.queue = kQueue;
  auto port = ipc::InPort::open(runtime, topic).value();
  auto waiter = ipc::Waiter::create(runtime);
  waiter.add(port);
  up_step_.reach(1);
  while (true) {
    waiter.wait(100ms);
    while (auto chunk = port.take()) {
      const ipc::LayersSample sample(std::move(*chunk));
      EXPECT(sample.size_xy() == LoggedLayers::kSize);
      EXPECT(pages_->count < kMost);
      LoggedLayers& page = pages_->layers[pages_->count];
      page.header = sample.header();
      const auto copy = [](const auto& from, auto& to) { std::copy(from.begin(), from.end(), to.begin()); };
      copy(sample.layer_f(LayerId::last_seen), page.last_seen_s);
      copy(sample.layer_u8(LayerId::visibility), page.visibility);
      copy(sample.layer_u8(LayerId::cost), page.cost);
      ++pages_->count;
    }
  }
}

bool LayersLog::gets(const std::function<bool(const LoggedLayers&)>& condition) const {
  std::size_t next = 0;
  return ipc::test::eventually([&] {
    while (next < size())
      if (condition((*this)[next++])) return true;
    return false;
  });
}

}  // namespace gvom::test
