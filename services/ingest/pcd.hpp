// Point clouds in PCD files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/ingest/fragments.hpp"

namespace gvom::ingest {

/// A number of each point, by the file's own type. PCD types: F (float), I and U (integers).
struct PcdField {
  std::string name;
  char type = 'F';
  std::size_t size = 4;    ///< Bytes: 1, 2, 4, 8.
  std::size_t count = 1;   ///< Values a point; 0: named in the header only.
  std::size_t offset = 0;  ///< Of the first point's value.
  std::size_t stride = 0;  ///< From a point to the next.
};

/// An opened PCD; `body` holds what `fields` point into.
struct PcdCloud {
  std::vector<PcdField> fields;
  std::size_t points = 0;
  std::size_t more_points = 0;  ///< What DATA binary or ascii holds beyond `points`.
  std::size_t height = 1;       ///< Above 1: organised, rows of equal length.
  Bytes body;

  /// Null if there is no such field.
  [[nodiscard]] const PcdField* find(const std::string& name) const;
  /// A floating-point field's value, any other type's converted.
  [[nodiscard]] double number(const PcdField& field, std::size_t point) const;
  [[nodiscard]] std::int64_t integer(const PcdField& field, std::size_t point) const;
};

/// Reads `file` (DATA ascii, binary, binary_compressed). Without POINTS there are WIDTH * HEIGHT. `scratch`
/// keeps the unpacked data; the cloud points into one of the two. Errors say what is wrong, without the
/// file's name.
tl::expected<PcdCloud, std::string> parse_pcd(Bytes file, std::vector<std::uint8_t>& scratch);

}  // namespace gvom::ingest
