#include "tools/endurance/ledger.hpp"

#include <algorithm>
#include <cstdlib>

namespace gvom::endurance {

namespace {

std::int64_t value_of(const tools::Counters& counters, const std::string& name) {
  for (const auto& [counter, value] : counters)
    if (counter == name) return static_cast<std::int64_t>(value);
  return 0;
}

std::int64_t sum_of(const tools::Counters& counters, std::initializer_list<const char*> names) {
  std::int64_t sum = 0;
  for (const char* const name : names) sum += value_of(counters, name);
  return sum;
}

std::int64_t nearest_to_zero(const std::int64_t* values, std::size_t count) {
  return *std::min_element(values, values + count,
                           [](auto a, auto b) { return std::llabs(a) < std::llabs(b); });
}

}  // namespace

void Balance::look(std::int64_t difference) {
  if (looks_ < kLooks) first_[looks_] = difference;
  newest_[looks_ % kLooks] = difference;
  ++looks_;
}

std::int64_t Balance::uncounted() const {
  const auto count = std::min<std::size_t>(looks_, kLooks);
  if (from_zero_) return count < 2 ? 0 : nearest_to_zero(newest_.data(), count);
  if (looks_ <= kLooks) return 0;
  // One of them may be off either way: a map was under way, or came between a Health and its being read.
  auto begins = first_;
  std::sort(begins.begin(), begins.end());
  const std::int64_t begin = begins[kLooks / 2];
  std::array<std::int64_t, kLooks> since{};
  std::transform(newest_.begin(), newest_.end(), since.begin(),
                 [begin](auto value) { return value - begin; });
  return nearest_to_zero(since.data(), count);
}

void Ledger::look_at_ingest(const std::string& process, const tools::Counters& counters, const Pause& pause) {
  balance(process + ": packets sent and not counted", pause.first_life)
      .look(static_cast<std::int64_t>(pause.packets) - sum_of(counters, {"packets", "drop_packet_kernel"}));
  balance(process + ": sweeps neither mapped nor counted as dropped", true)
      .look(value_of(counters, "sweeps_in") -
            sum_of(counters,
                   {"sweeps_mapped", "drop_before_odometry", "drop_odometry_timeout", "drop_after_odometry",
                    "drop_odometry_gap", "drop_odometry_jump", "drop_clock_offset", "drop_odometry_full",
                    "drop_overrun", "drop_no_chunk", "drop_backend_failed"}));
  if (pause.fusion_life == 0) return;
  const bool from_zero = pause.first_life && pause.fusion_life == 1;
  balance(process + ": maps that fusion " + std::to_string(pause.fusion_life) + " neither took nor missed",
          from_zero)
      .look(value_of(counters, "sweeps_mapped") - static_cast<std::int64_t>(pause.maps));
}

void Ledger::look_at_fusion(const std::string& process, const tools::Counters& counters, const Pause& pause) {
  balance(process + ": maps neither fused nor counted as dropped", true)
      .look(value_of(counters, "maps_in") -
            sum_of(counters, {"maps_fused", "drop_map_too_old", "drop_map_duplicate", "drop_map_wrong_grid",
                              "drop_map_old_epoch", "drop_map_before_jump", "drop_map_bad_directory",
                              "drop_map_bad_lookup", "drop_map_bad_columns", "drop_map_bad_lowest_rays",
                              "drop_map_bad_records", "drop_map_bad_epoch", "drop_map_bad_time",
                              "drop_map_backend_failed"}));
  balance(process + ": maps fused and no layers made of them", true)
      .look(value_of(counters, "maps_fused") -
            sum_of(counters, {"layers_out", "maps_sharing_layers", "drop_layers_no_chunk"}));
  if (pause.fusion_life == 0) return;
  balance(process + ": layers made and never numbered", true)
      .look(value_of(counters, "layers_out") - static_cast<std::int64_t>(pause.layers));
}

std::uint64_t Ledger::looks() const {
  std::uint64_t looks = 0;
  for (const auto& [what, balance] : balances_) looks += balance.looks();
  return looks;
}

std::vector<std::string> Ledger::defects() const {
  std::vector<std::string> defects;
  for (const auto& [what, balance] : balances_)
    if (balance.uncounted() != 0) defects.push_back(what + ": " + std::to_string(balance.uncounted()));
  return defects;
}

Balance& Ledger::balance(const std::string& what, bool from_zero) {
  return balances_.try_emplace(what, from_zero).first->second;
}

}  // namespace gvom::endurance
