#include "services/common/dds/cyclone_log.hpp"

#include <chrono>
#include <mutex>
#include <string_view>

#include <dds/ddsrt/log.h>

#include "services/common/log.hpp"

namespace gvom::dds {
namespace {

constexpr std::size_t kEnoughWords = 400;

/// Cyclone has one log for the whole process, and many threads.
struct Log {
  std::mutex mutex;
  bool keeping = false;
  std::string kept;
  services::LogEvery every{std::chrono::seconds(1)};
};

Log& the_log() {
  static Log log;
  return log;
}

void keep(std::string& kept, std::string_view words) {
  if (kept.size() > kEnoughWords) return;
  if (!kept.empty()) kept += "; ";
  kept += words;
}

void on_words(void*, const dds_log_data_t* said) noexcept {
  if ((said->priority & (DDS_LC_WARNING | DDS_LC_ERROR | DDS_LC_FATAL)) == 0) return;
  std::string_view words(said->message, said->size);
  words = words.substr(0, words.find_last_not_of(" \n") + 1);
  Log& log = the_log();
  const std::lock_guard lock(log.mutex);
  if (log.keeping) {
    keep(log.kept, words);
  } else {
    log.every(spdlog::level::warn, "Cyclone DDS: {}", words);
  }
}

}  // namespace

void take_cyclone_log() {
  dds_set_log_sink(on_words, nullptr);
}

CycloneWords::CycloneWords() {
  const std::lock_guard lock(the_log().mutex);
  the_log().keeping = true;
  the_log().kept.clear();
}

CycloneWords::~CycloneWords() {
  const std::lock_guard lock(the_log().mutex);
  the_log().keeping = false;
}

std::string CycloneWords::text() const {
  const std::lock_guard lock(the_log().mutex);
  return the_log().kept;
}

}  // namespace gvom::dds
