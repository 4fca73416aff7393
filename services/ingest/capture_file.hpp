// Opens captures as they lie on a disk, also packed.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include <tl/expected.hpp>

namespace gvom::ingest {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using CaptureFile = std::unique_ptr<std::FILE, CloseFile>;

/// The bytes of a capture; one that gzip packed is unpacked as it is read. Errors: no such file; packed by
/// something else, with the command that unpacks it.
tl::expected<CaptureFile, std::string> open_capture_file(const std::string& path);

}  // namespace gvom::ingest
