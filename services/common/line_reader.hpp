// Text files, line by line.
#pragma once

#include <fstream>
#include <string>

namespace gvom::services {

/// Gives the lines of a text file that are not blank, without their ends (LF or CRLF) and the blanks there.
/// A UTF-8 byte-order mark is passed over.
class LineReader {
 public:
  explicit LineReader(const std::string& path);

  /// Goes to the next line. False at the end, or if there is an `error`.
  bool next();

  [[nodiscard]] const std::string& text() const { return line_; }
  [[nodiscard]] int number() const { return number_; }
  /// "FILE:LINE: ", what a message about this line begins with.
  [[nodiscard]] std::string where() const { return path_ + ":" + std::to_string(number_) + ": "; }
  /// Empty if all is well; else the file and why it cannot be read, such as text in UTF-16.
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  void pass_mark();

  std::string path_;
  std::ifstream file_;
  std::string line_;
  int number_ = 0;
  std::string error_;
};

}  // namespace gvom::services
