// A socket pair between two of our processes that carries notes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace gvom::endurance {

enum class NoteKind : std::uint32_t {
  alive,        ///< AliveNote
  layers,       ///< LayersNote
  health,       ///< ipc::Health
  pools,        ///< ipc::PoolUse, one for each pool
  round_begin,  ///< RoundNote
  round_end,    ///< RoundNote
};

struct Note {
  NoteKind kind;
  std::vector<std::byte> payload;

  /// The payload as an M; zeros where it is shorter.
  template <typename M>
  [[nodiscard]] M as() const {
    M message{};
    std::memcpy(&message, payload.data(), payload.size() < sizeof message ? payload.size() : sizeof message);
    return message;
  }
  /// The payload as so many Ms as are whole.
  template <typename M>
  [[nodiscard]] std::vector<M> list_of() const {
    std::vector<M> list(payload.size() / sizeof(M));
    if (!list.empty()) std::memcpy(list.data(), payload.data(), list.size() * sizeof(M));
    return list;
  }
};

/// Waits while the other end is slow: no note is left out. False if there is no other end.
bool send_note(int socket, NoteKind kind, const void* payload, std::size_t bytes);

template <typename M>
bool send_note(int socket, NoteKind kind, const M& message) {
  return send_note(socket, kind, &message, sizeof message);
}

enum class Received { note, nothing, end };

/// What is there now.
Received receive_note(int socket, Note& out);

}  // namespace gvom::endurance
