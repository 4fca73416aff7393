// The files of a recording that has one file for each sweep.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace gvom::ingest {

struct ScanFile {
  std::string path;
  std::int64_t stamp_ns = 0;
};

/// True if `a` comes before `b` as a person counts: 8, 9, 10. Digits in a row are one number.
bool in_natural_order(const std::string& a, const std::string& b);

/// The scans of `path`, in natural order of their names: a folder with *.bin or *.pcd, a folder whose
/// `velodyne/`, `velodyne_points/data/` (KITTI raw) or `data/` has them, or one such file. Names that begin
/// with a dot are passed over.
/// Stamps are the lines of `times.txt` or `timestamps.txt` (see read_stamps) in the same folder or, if that
/// is called `velodyne`, `velodyne_points` or `data`, in the one above. Without such a file they are 0.1 s
/// from scan to scan, from 0, or for a single file 0, and a warning says so. Errors name the file and line:
/// no scans, both kinds, two files of times, another number of times than scans, time that does not go
/// forward.
tl::expected<std::vector<ScanFile>, std::string> list_scans(const std::string& path,
                                                            std::vector<std::string>& warnings);

}  // namespace gvom::ingest
