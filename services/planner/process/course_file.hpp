// A course as a file: places in odom, one a line.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace gvom::planner {

/// Reads `x_m,y_m` lines; a first line of words, and lines that begin with #, are passed over. Errors name
/// file and line: not two numbers, farther than 10,000 km, more than `most` places, none at all.
tl::expected<std::vector<Eigen::Vector2d>, std::string> read_course(const std::string& path,
                                                                    std::size_t most);

}  // namespace gvom::planner
