#include "tools/drive/cli/mcap_log.hpp"

#include <utility>

#include "services/planner/process/plan_message.hpp"

namespace gvom::driving {

using bridge::TopicId;

tl::expected<McapLog, std::string> McapLog::create(const std::string& path,
                                                   const services::VehicleConfig& config) {
  auto file = tools::MapFile::create(
      path, config, {TopicId::costmap, TopicId::layers, TopicId::tf, TopicId::plan, TopicId::trajectory});
  if (!file) return tl::unexpected(file.error());
  return McapLog(std::move(*file));
}

void McapLog::add(const Seen& seen, const planner::Plan& plan) {
  if (!written_) return;
  written_ = file_.put_layers(seen.layers, seen.grid, seen.state.T_odom_base, seen.state.stamp_ns);
  if (!written_) return;
  ipc::Plan message{};
  planner::fill(plan, message);
  written_ = file_.put_plan(message, seen.state.stamp_ns);
}

tl::expected<void, std::string> McapLog::close() {
  const auto closed = file_.close();
  return written_ ? closed : written_;
}

}  // namespace gvom::driving
