#include "ipc/error.hpp"

namespace gvom::ipc {

const char* to_string(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::bad_name:
      return "bad_name";
    case ErrorKind::unavailable:
      return "unavailable";
    case ErrorKind::in_use:
      return "in_use";
    case ErrorKind::denied:
      return "denied";
    case ErrorKind::exhausted:
      return "exhausted";
    case ErrorKind::too_large:
      return "too_large";
    case ErrorKind::no_space:
      return "no_space";
    case ErrorKind::timeout:
      return "timeout";
    case ErrorKind::stale:
      return "stale";
  }
  return "unknown";
}

}  // namespace gvom::ipc
