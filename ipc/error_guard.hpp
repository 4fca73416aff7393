// Between iceoryx's errors and ours. Internal to ipc/.
#pragma once

#include "ipc/runtime.hpp"

namespace gvom::ipc {

/// Takes over iceoryx's error handling and quiets its log, for the life of the process. What a call returns
/// as a value passes in silence, lesser errors are told to `log`, and one that iceoryx cannot go on from is
/// told and then ends the process at once: with exit code 70, or with 0 if `stop_asked` says that a stop was
/// asked for.
void install_error_guard(LogSink log, StopAsked stop_asked = {});

/// Lines go to stderr again, and `stop_asked` is asked for the last time: before what they use goes away.
void forget_callbacks();

/// One line to the sink.
void log_line(const std::string& line);

/// True if the last loan of this thread failed because no pool has chunks that large; forgets it.
bool take_chunk_too_large();

}  // namespace gvom::ipc
