#include "tools/drive/cli/witness.hpp"

#include "tools/drive/pictures/strip.hpp"

namespace gvom::driving {
namespace {

constexpr std::size_t kFrames = 8;

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
  return draw_strip(frames, film_.way(), world_.waypoints_m, vehicle, {world_.name, words})
      .write_png(picture_);
}

}  // namespace gvom::driving
