// Which files a bag has.
#pragma once

#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace gvom::bag {

/// The paths below `relative_file_paths` in the text of a metadata.yaml, in its order; empty if there are
/// none.
std::vector<std::string> listed_files(const std::string& metadata);

/// The files of the bag at `path`: of a folder all that there are, since metadata.yaml is missing or old
/// after a recorder was killed; where the two differ, `warnings` says how. Errors: nothing there, no bag.
tl::expected<std::vector<std::string>, std::string> bag_files(const std::string& path,
                                                              std::vector<std::string>& warnings);

}  // namespace gvom::bag
