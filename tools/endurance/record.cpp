#include "tools/endurance/record.hpp"

namespace gvom::endurance {

namespace {

/// Room for a new life: one that was too short to tell anything goes.
template <typename T>
T& begin_life(std::vector<T>& lives, bool newest_tells) {
  if (!lives.empty() && !newest_tells) lives.pop_back();
  return lives.emplace_back();
}

}  // namespace

void Record::add(const std::string& process, pid_t pid, double at_s, const ProcessSample& sample) {
  ProcessRecord& record = processes_[process];
  auto& lives = record.lives;
  if (lives.empty() || lives.back().pid != pid) {
    const bool tells =
        !lives.empty() && growth_of(lives.back().private_bytes, lives.back().begin_s + warm_up_s_);
    Life& life = begin_life(lives, tells);
    life.pid = pid;
    life.begin_s = at_s;
    ++record.starts;
  }
  Life& life = lives.back();
  if (!life.warm && at_s >= life.begin_s + warm_up_s_) {
    life.warm = true;
    life.warm_sample = sample;
  }
  life.newest = sample;
  life.private_bytes.add(at_s, static_cast<double>(sample.private_bytes));
  life.descriptors.add(at_s, static_cast<double>(sample.descriptors));
  life.threads.add(at_s, static_cast<double>(sample.threads));
}

void Record::add(const std::vector<ipc::PoolUse>& pools, pid_t broker, double at_s) {
  if (pools_.empty() || pools_.back().broker != broker) {
    const bool tells = !pools_.empty() && !pools_.back().used.empty() &&
                       growth_of(pools_.back().used.front(), pools_.back().begin_s + warm_up_s_);
    PoolLife& life = begin_life(pools_, tells);
    life.broker = broker;
    life.begin_s = at_s;
  }
  PoolLife& life = pools_.back();
  life.newest = pools;
  life.used.resize(pools.size());
  for (std::size_t i = 0; i < pools.size(); ++i) life.used[i].add(at_s, pools[i].used);
}

}  // namespace gvom::endurance
