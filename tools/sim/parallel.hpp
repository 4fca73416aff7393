// A loop whose turns do not depend on each other, over several threads.
#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace gvom::sim {

/// Calls `work(i)` for 0 <= i < count, in any order.
template <typename Work>
void parallel_for(int count, int threads, const Work& work) {
  std::atomic<int> next{0};
  const auto loop = [&] {
    for (int i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(loop);
  loop();
  for (std::thread& other : others) other.join();
}

}  // namespace gvom::sim
