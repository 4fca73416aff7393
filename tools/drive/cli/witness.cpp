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

Witness::Witness(const std::string& folder, const CourseWorld& world, std::uint64_t seed, Strips strips)
    : file_(folder, world.name, seed),
      file_looks_(file_.onlooker()),
      world_(world),
      picture_(folder + "/" + world.name + "-" + std::to_string(seed) + ".png"),
      strips_(folder.empty() ? Strips::none : strips) {}

Onlooker Witness::onlooker() {
  if (strips_ == Strips::none) return file_looks_;
  return [this](const Seen& seen, const planner::Plan& plan) {
    if (file_looks_) file_looks_(seen, plan);
    film_.add(seen, plan);
  };
}

tl::expected<void, std::string> Witness::finish(const planner::VehicleLimits& vehicle, Outcome outcome,
                                                const std::string& words) const {
  const bool failed = outcome != Outcome::arrived;
  if (strips_ == Strips::none || (strips_ == Strips::failed && !failed) || film_.empty()) return {};
  const auto frames = failed ? film_.pick_end(kFrames) : film_.pick(kFrames);
  return draw_strip(frames, surroundings_of(film_, world_, frames), vehicle, {world_.name, words})
      .write_png(picture_);
}

}  // namespace gvom::driving
