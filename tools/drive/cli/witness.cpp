#include "tools/drive/cli/witness.hpp"

#include "tools/drive/pictures/strip.hpp"

namespace gvom::driving {
namespace {

constexpr std::size_t kFrames = 8;
constexpr double kTruth_m = 0.2;  // its columns

Surroundings surroundings_of(const Film& film, const CourseWorld& course,
                             const std::vector<const Frame*>& frames) {
  const sim::World world(course.data);
  const sim::GroundTruth truth = sim::sample_truth(world, {kTruth_m});
  const TrueObstacles obstacles(world, truth);
  Surroundings around{film.way(), course.waypoints_m, obstacles.edges(), {}};
  for (const Frame* frame : frames)
    around.walkers.push_back(
        obstacles.walker_edges(1e-9 * static_cast<double>(frame->stamp_ns - sim::kStartNs)));
  return around;
}

}  // namespace

tl::expected<Strips, std::string> find_strips(const std::string& name) {
  if (name == "none") return Strips::none;
  if (name == "failed") return Strips::failed;
  if (name == "all") return Strips::all;
  return tl::unexpected(name + ": not known; none, failed or all");
}

Witness::Witness(const Keeping& keeping, const CourseWorld& world, std::uint64_t seed,
                 const services::VehicleConfig& config)
    : file_(keeping.folder, world.name, seed),
      file_looks_(file_.onlooker()),
      world_(world),
      vehicle_(config.planner.vehicle),
      picture_(keeping.folder + "/" + world.name + "-" + std::to_string(seed) + ".png"),
      strips_(keeping.folder.empty() ? Strips::none : keeping.strips) {
  if (keeping.mcap && !keeping.folder.empty())
    mcap_ = McapLog::create(keeping.folder + "/" + world.name + "-" + std::to_string(seed) + ".mcap", config);
}

Onlooker Witness::onlooker() {
  return [this](const Seen& seen, const planner::Plan& plan) {
    if (file_looks_) file_looks_(seen, plan);
    if (strips_ != Strips::none) film_.add(seen, plan);
    if (mcap_ && *mcap_) (*mcap_)->add(seen, plan);
  };
}

tl::expected<void, std::string> Witness::finish(Outcome outcome, const std::string& words) {
  const bool failed = outcome != Outcome::arrived;
  if (const auto closed = file_.close(); !closed) return closed;
  if (mcap_ && !*mcap_) return tl::unexpected(mcap_->error());
  if (mcap_)
    if (const auto closed = (*mcap_)->close(); !closed) return closed;
  if (strips_ == Strips::none || (strips_ == Strips::failed && !failed) || film_.empty()) return {};
  const auto frames = failed ? film_.pick_end(kFrames) : film_.pick(kFrames);
  return draw_strip(frames, surroundings_of(film_, world_, frames), vehicle_, {world_.name, words})
      .write_png(picture_);
}

}  // namespace gvom::driving
