#include "ipc/error_guard.hpp"

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <utility>

#include "iceoryx_hoofs/error_handling/error_handling.hpp"
#include "iceoryx_hoofs/log/logmanager.hpp"

namespace gvom::ipc {
namespace {

constexpr int kExitStopped = 0;
constexpr int kExitInternal = 70;

std::mutex callbacks_mutex;

/// Never destroyed: iceoryx reports errors until the very end of the process.
LogSink& sink() {
  static auto* const instance = new LogSink;
  return *instance;
}

/// Likewise.
StopAsked& stop_question() {
  static auto* const instance = new StopAsked;
  return *instance;
}

bool stop_was_asked() {
  const std::lock_guard lock(callbacks_mutex);
  return stop_question() && stop_question()();
}

thread_local bool chunk_too_large = false;

/// Errors that the failing call also returns as a value; its caller counts and tells them.
bool is_returned_as_value(iox::Error error) {
  switch (error) {
    case iox::Error::kMEPOO__MEMPOOL_GETCHUNK_CHUNK_IS_TOO_LARGE:
    case iox::Error::kMEPOO__MEMPOOL_GETCHUNK_CHUNK_WITHOUT_MEMPOOL:
      chunk_too_large = true;
      return true;
    case iox::Error::kMEPOO__MEMPOOL_GETCHUNK_POOL_IS_RUNNING_OUT_OF_CHUNKS:
    case iox::Error::kMEPOO__CANNOT_ALLOCATE_CHUNK:
      return true;
    default:
      return false;
  }
}

void handle(iox::Error error, const std::function<void()>& callback, iox::ErrorLevel level) {
  if (is_returned_as_value(error)) return;
  const std::string name = iox::ErrorHandler::toString(error);
  if (level == iox::ErrorLevel::MODERATE) {
    log_line("iceoryx: " + name);
    return;
  }
  const int code = stop_was_asked() ? kExitStopped : kExitInternal;
  log_line("iceoryx cannot go on: " + name + "; leaving with exit code " + std::to_string(code));
  if (callback) callback();
  std::_Exit(code);
}

}  // namespace

void install_error_guard(LogSink log, StopAsked stop_asked) {
  {
    const std::lock_guard lock(callbacks_mutex);
    sink() = std::move(log);
    stop_question() = std::move(stop_asked);
  }
  // Never destroyed either. Volatile: a pointer that nobody reads is not kept, and what it points to leaks.
  static iox::cxx::GenericRAII* volatile const installed =
      new iox::cxx::GenericRAII(iox::ErrorHandler::setTemporaryErrorHandler(handle));
  static_cast<void>(installed);
  // What matters of its log reaches the handler too; the rest repeats what calls return.
  iox::log::LogManager::GetLogManager().SetDefaultLogLevel(iox::log::LogLevel::kFatal,
                                                           iox::log::LogLevelOutput::kHideLogLevel);
}

void forget_callbacks() {
  const bool stopped = stop_was_asked();
  const std::lock_guard lock(callbacks_mutex);
  sink() = nullptr;
  stop_question() = [stopped] { return stopped; };
}

void log_line(const std::string& line) {
  const std::lock_guard lock(callbacks_mutex);
  if (sink()) {
    sink()(line);
  } else {
    std::fprintf(stderr, "%s\n", line.c_str());
  }
}

bool take_chunk_too_large() {
  return std::exchange(chunk_too_large, false);
}

}  // namespace gvom::ipc
