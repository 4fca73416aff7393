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

/// The scans of `path`, in order of their names: a folder with *.bin or *.pcd, a folder whose `velodyne/` has
/// them, or one such file. Stamps are the lines of `times.txt` (decimal seconds), in the same folder or, if
/// that is called `velodyne`, the one above; without it, 0.1 s from scan to scan, from 0, and a warning.
/// Errors name the file and line: no scans, both kinds, another number of lines, time that does not go
/// forward.
tl::expected<std::vector<ScanFile>, std::string> list_scans(const std::string& path,
                                                            std::vector<std::string>& warnings);

}  // namespace gvom::ingest
