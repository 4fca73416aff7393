// Between iceoryx's errors and ours. Internal to ipc/.
#pragma once

#include "ipc/runtime.hpp"

namespace gvom::ipc {

/// Takes over iceoryx's error handling and quiets its log, for the life of the process. What a call returns
/// as a value passes in silence, lesser errors are told to `log`, and one that iceoryx cannot go on from is
/// told and then ends the process with exit code 70 at once.
void install_error_guard(LogSink log);

/// Lines go to stderr again: before what `log` uses goes away.
void forget_log_sink();

/// One line to the sink.
void log_line(const std::string& line);

/// True if the last loan of this thread failed because no pool has chunks that large; forgets it.
bool take_chunk_too_large();

}  // namespace gvom::ipc
