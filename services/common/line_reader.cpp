#include "services/common/line_reader.hpp"

#include <cerrno>
#include <cstring>

namespace gvom::services {

namespace {

bool begins_with(const std::string& text, const std::string& mark) {
  return text.compare(0, mark.size(), mark) == 0;
}

}  // namespace

LineReader::LineReader(const std::string& path) : path_(path) {
  errno = 0;
  file_.open(path);
  if (!file_) error_ = path_ + ": " + std::strerror(errno);
}

bool LineReader::next() {
  while (error_.empty() && std::getline(file_, line_)) {
    if (++number_ == 1) pass_mark();
    line_.erase(line_.find_last_not_of(" \t\r\f\v") + 1);
    if (error_.empty() && !line_.empty()) return true;
  }
  if (file_.bad()) error_ = path_ + ": " + std::strerror(errno);
  return false;
}

/// Of UTF-8: editors on Windows write it. The marks of UTF-16 and UTF-32 begin alike.
void LineReader::pass_mark() {
  if (begins_with(line_, "\xEF\xBB\xBF")) line_.erase(0, 3);
  if (begins_with(line_, "\xFF\xFE") || begins_with(line_, "\xFE\xFF") ||
      begins_with(line_, std::string("\0\0\xFE\xFF", 4)))
    error_ = path_ + ": is text in UTF-16 or UTF-32: save it as UTF-8";
}

}  // namespace gvom::services
