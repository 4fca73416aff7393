// A byte for each column of the map, that stays where it is when the map moves.
#pragma once

#include <cstdint>
#include <vector>

#include "services/planner/map_view.hpp"

namespace gvom::planner {

class CarriedCells {
 public:
  /// @param n_xy the largest map, columns along an edge
  explicit CarriedCells(int n_xy);

  /// All are 0.
  void clear();
  /// To the columns of this map. What it did not have before is 0, and so is all of a map of another size.
  void carry(const Cells& cells);

  [[nodiscard]] const Cells& cells() const { return cells_; }
  [[nodiscard]] std::uint8_t& operator[](int cell) { return values_[static_cast<std::size_t>(cell)]; }
  [[nodiscard]] std::uint8_t operator[](int cell) const { return values_[static_cast<std::size_t>(cell)]; }

 private:
  Cells cells_;
  std::vector<std::uint8_t> values_, before_;
};

}  // namespace gvom::planner
