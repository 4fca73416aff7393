// How far a course was driven, in a file: the successor of a planner that died goes on from there.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gvom::planner {

/// What tells one course from all others of this boot.
struct CourseName {
  std::uint64_t publisher = 0;  ///< On the bus; 0: the course is of a file.
  std::uint64_t sequence = 0;   ///< Of its messages.
  std::uint64_t places = 0;     ///< A number for where they are.

  [[nodiscard]] bool is_of_file() const { return publisher == 0; }
  bool operator==(const CourseName& other) const {
    return publisher == other.publisher && sequence == other.sequence && places == other.places;
  }
};

CourseName name_of(std::uint64_t publisher, std::uint64_t sequence,
                   const std::vector<Eigen::Vector2d>& places_m);

class CourseRecord {
 public:
  explicit CourseRecord(std::string path) : path_(std::move(path)) {}

  /// Where a process on the bus has its record: beside its socket and lock.
  static std::string path_of(const std::string& process);

  /// The place that was driven to when it was written; 0 if it is of another course or boot, damaged, or of
  /// another user.
  [[nodiscard]] std::size_t place_of(const CourseName& name) const;
  /// Each cycle: writes what is new. That it cannot be written is logged once.
  void note(const CourseName& name, std::size_t place);
  void forget();

 private:
  struct Written {
    CourseName name;
    std::size_t place;
  };

  std::string path_;
  std::optional<Written> written_;
  bool told_ = false;
};

}  // namespace gvom::planner
