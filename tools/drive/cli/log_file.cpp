#include "tools/drive/cli/log_file.hpp"

#include <filesystem>

namespace gvom::driving {

DriveFile::DriveFile(const std::string& folder, const std::string& world, std::uint64_t seed) {
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  path_ = folder + "/" + world + "-" + std::to_string(seed) + ".csv";
  file_.open(path_);
  file_ << "time_s,x_m,y_m,speed_mps,curvature_per_m,mode,command_mps,command_per_m,waypoint,cost_to_go,seen_"
           "m,why\n";
}

Onlooker DriveFile::onlooker() {
  if (path_.empty()) return {};
  return [this](const Seen& seen, const planner::Plan& plan) { write(seen, plan); };
}

void DriveFile::write(const Seen& seen, const planner::Plan& plan) {
  const planner::State& state = seen.state;
  const double time_s = 1e-9 * static_cast<double>(state.stamp_ns - sim::kStartNs);
  file_ << time_s << ',' << state.T_odom_base.translation_m.x() << ',' << state.T_odom_base.translation_m.y()
        << ',' << state.speed_mps << ',' << state.curvature_per_m << ',' << static_cast<int>(plan.mode) << ','
        << plan.command.speed_mps << ',' << plan.command.curvature_per_m << ',' << plan.waypoint << ','
        << plan.cost_to_go << ',' << plan.seen_m << ",\"" << plan.why << "\"\n"
        << std::flush;
}

tl::expected<void, std::string> DriveFile::close() {
  if (path_.empty()) return {};
  file_.close();
  if (!file_) return tl::unexpected(path_ + ": cannot be written");
  return {};
}

}  // namespace gvom::driving
