// Two folders of gvom-map, array by array.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace gvom::compare {

struct FolderComparison {
  std::size_t arrays = 0;                ///< That are in the folder of what is expected.
  std::vector<std::string> differences;  ///< Each of one array, in order of their names.
};

/// Compares every .npy file below two folders, byte for byte; a file that only one of them has is a
/// difference.
/// @param ignored file names to leave out, such as "voxels.npy"
/// Error: a folder cannot be read.
tl::expected<FolderComparison, std::string> compare_folders(const std::string& expected,
                                                            const std::string& found,
                                                            const std::set<std::string>& ignored);

/// What a person reads: the first differences in full, then one line each, then how many more there are.
/// One line where there are none.
std::string report(const FolderComparison& comparison);

}  // namespace gvom::compare
