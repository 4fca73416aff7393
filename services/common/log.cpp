#include "services/common/log.hpp"

#include <cstdio>
#include <cstdlib>
#include <memory>

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <sys/stat.h>
#include <unistd.h>

#include "services/common/lifecycle.hpp"

namespace gvom::services {

namespace {

/// JOURNAL_STREAM is DEVICE:INODE of what systemd made stderr; a redirected child inherits only the variable.
bool stderr_is_journal() {
  const char* const stream = std::getenv("JOURNAL_STREAM");
  struct stat status {};
  if (stream == nullptr || fstat(STDERR_FILENO, &status) != 0) return false;
  return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino) == stream;
}

/// The priority that journald reads off the front of a line, as in sd-daemon.h.
class JournalPriority : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& out) override {
    const std::string_view prefix = prefix_of(message.level);
    out.append(prefix.data(), prefix.data() + prefix.size());
  }

  [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<JournalPriority>();
  }

 private:
  static std::string_view prefix_of(spdlog::level::level_enum level) {
    switch (level) {
      case spdlog::level::critical:
        return "<2>";
      case spdlog::level::err:
        return "<3>";
      case spdlog::level::warn:
        return "<4>";
      case spdlog::level::info:
        return "<6>";
      default:
        return "<7>";
    }
  }
};

/// The last error stands as systemd's status, also when the process has ended: `systemctl status` and gvomctl
/// say why. A process that goes on tells its rate there soon again.
class StatusSink : public spdlog::sinks::base_sink<std::mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    notify_status(std::string(message.payload.data(), message.payload.size()).c_str());
  }
  void flush_() override {}
};

}  // namespace

void init_logging(const std::string& process_name) {
  auto status = std::make_shared<StatusSink>();
  status->set_level(spdlog::level::err);
  const spdlog::sinks_init_list sinks = {std::make_shared<spdlog::sinks::stderr_sink_mt>(), status};
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(process_name, sinks));
  if (!stderr_is_journal()) {
    spdlog::set_pattern("%H:%M:%S.%e %n %l: %v");
    return;
  }
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<JournalPriority>('*').set_pattern("%*%v");
  spdlog::set_formatter(std::move(formatter));
}

bool LogEvery::take_turn() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) {
    ++held_back_;
    return false;
  }
  next_ = now + period_;
  return true;
}

}  // namespace gvom::services
