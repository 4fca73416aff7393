#include "services/ingest/fragments.hpp"

#include <algorithm>
#include <cstring>

namespace gvom::ingest {

FragmentTable::FragmentTable(SourceCounters& counters) : counters_(counters) {
  for (Slot& slot : slots_) slot.bytes.resize(kMaxBytes);
}

void FragmentTable::give_up(Slot& slot) {
  slot.open = false;
  ++counters_.lost_fragments;
  ++lonely_;
}

void FragmentTable::clear() {
  for (Slot& slot : slots_) {
    if (slot.open) give_up(slot);
  }
}

FragmentTable::Slot& FragmentTable::slot_of(const Fragment& fragment) {
  for (Slot& slot : slots_) {
    if (!slot.open) continue;
    if (fragment.capture_ns - slot.key.capture_ns > kMaxAgeNs) {
      give_up(slot);
    } else if (slot.key.id == fragment.id && slot.key.source == fragment.source &&
               slot.key.destination == fragment.destination) {
      return slot;
    }
  }
  Slot& slot = *std::min_element(slots_.begin(), slots_.end(), [](const Slot& a, const Slot& b) {
    return a.open != b.open ? !a.open : a.order < b.order;
  });
  if (slot.open) give_up(slot);
  slot.open = true;
  slot.key = fragment;
  slot.order = ++order_;
  slot.total = slot.end = slot.received = 0;
  slot.units.reset();
  return slot;
}

void FragmentTable::store(Slot& slot, const Fragment& fragment) {
  for (std::size_t at = 0; at < fragment.size; at += 8) {
    const std::size_t unit = (fragment.offset + at) / 8;
    if (slot.units[unit]) continue;
    const std::size_t length = std::min<std::size_t>(8, fragment.size - at);
    std::memcpy(&slot.bytes[fragment.offset + at], fragment.data + at, length);
    slot.units[unit] = true;
    slot.received += length;
  }
  slot.end = std::max(slot.end, fragment.offset + fragment.size);
}

Bytes FragmentTable::add(const Fragment& fragment) {
  ++counters_.fragments;
  any_other_ = any_other_ || fragment.offset != 0;
  Slot& slot = slot_of(fragment);
  const bool malformed = fragment.size == 0 || fragment.offset + fragment.size > kMaxBytes ||
                         (fragment.more && fragment.size % 8 != 0);
  if (malformed) {
    give_up(slot);
    return {};
  }
  store(slot, fragment);
  if (!fragment.more) slot.total = fragment.offset + fragment.size;
  if (slot.total == 0) return {};
  if (slot.end > slot.total) {
    give_up(slot);
    return {};
  }
  if (slot.received < slot.total) return {};
  slot.open = false;
  return {slot.bytes.data(), slot.total};
}

}  // namespace gvom::ingest
