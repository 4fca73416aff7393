// Scans as files: .bin and .pcd, made and read.
#pragma once

#include <string>
#include <vector>

#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

namespace gvom::test {

inline std::string write(const std::string& path, const ByteVector& bytes) {
  return write_text(path, std::string(bytes.begin(), bytes.end()));
}

inline ByteVector bin(const std::vector<float>& values) {
  ByteVector out;
  for (const float value : values) put_le(out, value);
  return out;
}

inline std::string header(const std::string& fields, const std::string& sizes, const std::string& types,
                          int points, const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nWIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) +
         "\nDATA " + data + "\n";
}

inline ByteVector joined(const std::string& text, const ByteVector& body) {
  ByteVector out(text.begin(), text.end());
  append(out, body);
  return out;
}

inline Sweep only_sweep(const std::string& path) {
  auto source = open("scans:" + path);
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 1);
  return sweeps[0];
}

/// The error of reading the only file.
inline std::string read_error(const std::string& path) {
  auto source = open("scans:" + path);
  Sweep sweep;
  const auto event = source->next(sweep, std::chrono::milliseconds(0));
  REQUIRE_FALSE(event.has_value());
  CHECK(event.error().find(path) == 0);
  CHECK(source->next(sweep, std::chrono::milliseconds(0)).value() == ingest::SourceEvent::kEnd);
  return event.error();
}

}  // namespace gvom::test
