// The line from a column to the vehicle (R11, R13), from the text of core/README.md alone.
#pragma once

#include <array>

namespace gvom::oracle {

struct ColumnAt {
  int x;
  int y;
};

class SightLine {
 public:
  SightLine(const ColumnAt& column, const ColumnAt& vehicle);

  /// Columns along the main axis to the vehicle's; 0: there is no line.
  [[nodiscard]] int length() const { return length_; }
  /// Length of a step, metres.
  [[nodiscard]] double step_m(double resolution_m) const;
  /// The column at a step towards the vehicle; away from it if it is negative.
  [[nodiscard]] ColumnAt at(int step) const { return beside(step, 0); }
  [[nodiscard]] std::array<ColumnAt, 3> abreast(int step) const {
    return {beside(step, 0), beside(step, -1), beside(step, 1)};
  }

 private:
  [[nodiscard]] ColumnAt beside(int step, int side) const;

  ColumnAt column_;
  int dx_, dy_;
  int length_;
};

}  // namespace gvom::oracle
