#include "tools/drive/ablation.hpp"

#include <algorithm>

#include "core/cpu/fusion.hpp"
#include "tools/drive/paper_fusion.hpp"

namespace gvom::driving {

const char* name_of(Ablation ablation) {
  switch (ablation) {
    case Ablation::none:
      return "none";
    case Ablation::deskew_off:
      return "deskew-off";
    case Ablation::memory_off:
      return "memory-off";
    case Ablation::one_lidar:
      return "one-lidar";
    case Ablation::paper_r9:
      return "paper-R9";
    case Ablation::paper_r13:
      break;
  }
  return "paper-R13";
}

tl::expected<Ablation, std::string> find_ablation(const std::string& name) {
  std::string all;
  for (const Ablation ablation : kAblations) {
    if (name == name_of(ablation)) return ablation;
    all += std::string(all.empty() ? "" : ", ") + name_of(ablation);
  }
  return tl::unexpected(name + ": no such ablation; there are " + all);
}

tl::expected<Rig, std::string> ablated(Rig rig, Ablation ablation) {
  if (ablation == Ablation::memory_off) rig.mapping.mapper.memory.max_age_s = 0;
  if (ablation == Ablation::one_lidar) {
    if (rig.mapping.lidars.size() < 2)
      return tl::unexpected(std::string("one-lidar: the vehicle has no other lidar that could be silent"));
    rig.mapping.lidars.resize(1);
  }
  return rig;
}

void forget_times(Sweep& sweep) {
  std::fill(sweep.times_ns.begin(), sweep.times_ns.end(), sweep.stamp_ns);
}

std::unique_ptr<FusionBackend> make_fusion(const MapperConfig& config, Ablation ablation) {
  if (ablation == Ablation::paper_r9) return std::make_unique<PaperFusion>(config, PaperRule::r9);
  if (ablation == Ablation::paper_r13) return std::make_unique<PaperFusion>(config, PaperRule::r13);
  return std::make_unique<cpu::Fusion>(config);
}

}  // namespace gvom::driving
