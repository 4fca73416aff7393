#include "services/planner/process/course_record.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <sstream>
#include <string_view>

#include "services/common/own_file.hpp"
#include "services/common/text_hash.hpp"

namespace gvom::planner {
namespace {

/// All of a record but the place.
std::string title_of(const CourseName& name) {
  std::ostringstream title;
  title << "gvom course, boot " << services::boot_id() << ", publisher " << name.publisher << ", message "
        << name.sequence << ", places " << name.places << ", driven to ";
  return title.str();
}

}  // namespace

CourseName name_of(std::uint64_t publisher, std::uint64_t sequence,
                   const std::vector<Eigen::Vector2d>& places_m) {
  services::TextHash hash;
  for (const Eigen::Vector2d& place_m : places_m)
    hash.add({reinterpret_cast<const char*>(place_m.data()), 2 * sizeof(double)});
  return {publisher, sequence, hash.value()};
}

std::string CourseRecord::path_of(const std::string& process) {
  return "/tmp/" + process + ".course";
}

std::size_t CourseRecord::place_of(const CourseName& name) const {
  const auto text = services::read_own(path_);
  const std::string title = title_of(name);
  if (!text || !*text || (*text)->rfind(title, 0) != 0) return 0;
  std::istringstream rest((*text)->substr(title.size()));
  std::size_t place = 0;
  char end = 0;
  return rest >> place && rest.get(end) && end == '\n' ? place : 0;
}

void CourseRecord::note(const CourseName& name, std::size_t place) {
  if (written_ && written_->name == name && written_->place == place) return;
  written_ = {name, place};
  const auto done = services::replace_own(path_, title_of(name) + std::to_string(place) + '\n');
  if (done || told_) return;
  told_ = true;
  spdlog::warn("a planner that is started again begins its course anew: {}", done.error());
}

void CourseRecord::forget() {
  written_.reset();
  ::unlink(path_.c_str());
}

}  // namespace gvom::planner
