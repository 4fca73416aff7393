#include "services/planner/words.hpp"

#include <array>
#include <cstdarg>
#include <cstdio>

#include "services/planner/planner.hpp"

namespace gvom::planner {

void say(std::string& why, const char* format, ...) {
  std::array<char, kLongestWhy + 1> text{};
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text.data(), text.size(), format, arguments);
  va_end(arguments);
  why.assign(text.data());
}

const char* words_of(Reason reason) {
  switch (reason) {
    case Reason::none:
      return "nothing hinders it";
    case Reason::no_course:
      return "no course";
    case Reason::no_layers:
      return "no layers";
    case Reason::stale_layers:
      return "the layers are too old";
    case Reason::blind_side:
      return "no lidar looks where it drives";
    case Reason::odometry_jump:
      return "odometry jumped";
    case Reason::no_odometry:
      return "no odometry";
    case Reason::overrun:
      return "planning took too long";
    case Reason::no_way:
      return "no way to the waypoint";
    case Reason::goal_in_obstacle:
      return "the waypoint lies in an obstacle";
    case Reason::stands_in_obstacle:
      return "it stands in an obstacle";
    case Reason::no_trajectory:
      return "no free trajectory";
    case Reason::unseen_ground:
      return "unseen ground";
    case Reason::rough:
      return "rough ground";
    case Reason::steep:
      return "steep ground";
    case Reason::curve:
      return "a curve";
    case Reason::near_goal:
      return "the goal";
    case Reason::mover:
      return "something moves where it would drive";
    case Reason::dead_end:
      return "a dead end";
    case Reason::no_progress:
      return "no progress";
  }
  return "?";
}

}  // namespace gvom::planner
