#include "services/common/dds/blob_type.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <functional>
#include <new>
#include <utility>
#include <vector>

#include <dds/ddsi/q_protocol.h>
#include <dds/ddsi/q_radmin.h>
#include <dds/ddsrt/heap.h>

#include "services/common/dds/domain.hpp"

namespace gvom::dds {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kHead = 4;

/// A message of Cyclone's, and its bytes; none where it stands for the (only) instance.
struct Message : ddsi_serdata {
  Message(const ddsi_sertype* of, ddsi_serdata_kind which, ros::Blob bytes)
      : ddsi_serdata{}, cdr(std::move(bytes)) {
    ddsi_serdata_init(this, of, which);
  }
  ros::Blob cdr;
  std::int64_t sequence = 0;
};

const Message& of(const ddsi_serdata* message) {
  return *static_cast<const Message*>(message);
}

/// Null where there is no memory: to Cyclone that is a message that cannot be read. C calls the functions
/// below, and knows no exceptions.
Message* make(const ddsi_sertype* type, ddsi_serdata_kind kind, ros::Blob bytes) noexcept {
  return new (std::nothrow) Message(type, kind, std::move(bytes));
}

std::uint32_t size_of(const ddsi_serdata* message) noexcept {
  return of(message).cdr ? static_cast<std::uint32_t>(of(message).cdr->size()) : 0;
}

/// Pieces of one message come in order, maybe some bytes twice. False if any are missing.
bool gather(const nn_rdata* piece, std::size_t size, Bytes& out) {
  for (; piece != nullptr && out.size() < size; piece = piece->nextfrag) {
    if (piece->min > out.size()) return false;
    if (piece->maxp1 <= out.size()) continue;
    const std::uint8_t* const bytes = NN_RMSG_PAYLOADOFF(piece->rmsg, NN_RDATA_PAYLOAD_OFF(piece));
    const std::size_t end = std::min<std::size_t>(piece->maxp1, size);
    out.insert(out.end(), bytes + (out.size() - piece->min), bytes + (end - piece->min));
  }
  return out.size() == size;
}

/// Cyclone tells a reader of no gap in what a best-effort writer sent, so this looks into the packet.
std::int64_t sequence_of(const nn_rdata* piece) {
  if (NN_RDATA_SUBMSG_OFF(piece) == 0) return 0;
  Data_DataFrag_common head;
  std::memcpy(&head, NN_RMSG_PAYLOADOFF(piece->rmsg, NN_RDATA_SUBMSG_OFF(piece)), sizeof head);
  return std::int64_t{head.writerSN.high} * (std::int64_t{1} << 32) + head.writerSN.low;
}

ddsi_serdata* from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* pieces,
                          std::size_t size) noexcept {
  if (kind != SDK_DATA) return make(type, kind, nullptr);
  if (size < kHead || size > kLargestMessage) return nullptr;
  try {
    const auto bytes = std::make_shared<Bytes>();
    bytes->reserve(size);
    Message* const message = gather(pieces, size, *bytes) ? make(type, kind, bytes) : nullptr;
    if (message != nullptr) message->sequence = sequence_of(pieces);
    return message;
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

ddsi_serdata* from_parts(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* parts, std::size_t size) noexcept {
  if (kind != SDK_DATA) return make(type, kind, nullptr);
  if (size < kHead || size > kLargestMessage) return nullptr;
  try {
    const auto bytes = std::make_shared<Bytes>();
    bytes->reserve(size);
    for (ddsrt_msg_iovlen_t i = 0; i < count; ++i) {
      const auto* const part = static_cast<const std::uint8_t*>(parts[i].iov_base);
      bytes->insert(bytes->end(), part, part + parts[i].iov_len);
    }
    return make(type, kind, bytes);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

ddsi_serdata* from_key(const ddsi_sertype* type, const ddsi_keyhash*) noexcept {
  return make(type, SDK_KEY, nullptr);
}

/// Nobody here writes anything but blobs.
ddsi_serdata* from_sample(const ddsi_sertype*, ddsi_serdata_kind, const void*) noexcept {
  return nullptr;
}

ddsi_serdata* instance_of(const ddsi_serdata* message) noexcept {
  return make(message->type, SDK_KEY, nullptr);
}

/// The end of the last piece is asked for in whole words of four bytes: 0 beyond the message's.
void copy_out(const ddsi_serdata* message, std::size_t offset, std::size_t size, void* out) noexcept {
  const std::size_t have = size_of(message);
  const std::size_t copied = offset < have ? std::min(size, have - offset) : 0;
  if (copied > 0) std::memcpy(out, of(message).cdr->data() + offset, copied);
  std::memset(static_cast<std::uint8_t*>(out) + copied, 0, size - copied);
}

/// A piece within the blob is lent; one that reaches beyond its end is a copy, which `unlend` frees.
ddsi_serdata* lend(const ddsi_serdata* message, std::size_t offset, std::size_t size,
                   ddsrt_iovec_t* out) noexcept {
  out->iov_len = size;
  if (offset + size <= size_of(message)) {
    out->iov_base = const_cast<std::uint8_t*>(of(message).cdr->data() + offset);
  } else {
    out->iov_base = ddsrt_malloc(size);
    copy_out(message, offset, size, out->iov_base);
  }
  return ddsi_serdata_ref(message);
}

void unlend(ddsi_serdata* message, const ddsrt_iovec_t* lent) noexcept {
  const auto* const begin = of(message).cdr ? of(message).cdr->data() : nullptr;
  const auto* const piece = static_cast<const std::uint8_t*>(lent->iov_base);
  const bool is_lent = begin != nullptr && std::less_equal<>()(begin, piece) &&
                       std::less_equal<>()(piece + lent->iov_len, begin + size_of(message));
  if (!is_lent) ddsrt_free(lent->iov_base);
  ddsi_serdata_unref(message);
}

bool to_sample(const ddsi_serdata*, void*, void**, void*) noexcept {
  return false;
}

bool instance_to_sample(const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) noexcept {
  return false;
}

bool same_instance(const ddsi_serdata*, const ddsi_serdata*) noexcept {
  return true;
}

void free_message(ddsi_serdata* message) noexcept {
  delete static_cast<Message*>(message);
}

std::size_t print(const ddsi_sertype*, const ddsi_serdata* message, char* out, std::size_t size) noexcept {
  return static_cast<std::size_t>(std::snprintf(out, size, "(%u bytes)", size_of(message)));
}

void key_hash(const ddsi_serdata*, ddsi_keyhash* out, bool) noexcept {
  *out = {};
}

void free_type(ddsi_sertype* type) noexcept {
  ddsi_sertype_fini(type);
  delete type;
}

// Whatever has the same name and these operations is the same type.
bool same_type(const ddsi_sertype*, const ddsi_sertype*) noexcept {
  return true;
}

std::uint32_t hash_of_type(const ddsi_sertype*) noexcept {
  return 0;
}

ddsi_serdata_ops message_operations() {
  ddsi_serdata_ops ops{};
  ops.eqkey = same_instance;
  ops.get_size = size_of;
  ops.from_ser = from_pieces;
  ops.from_ser_iov = from_parts;
  ops.from_keyhash = from_key;
  ops.from_sample = from_sample;
  ops.to_ser = copy_out;
  ops.to_ser_ref = lend;
  ops.to_ser_unref = unlend;
  ops.to_sample = to_sample;
  ops.to_untyped = instance_of;
  ops.untyped_to_sample = instance_to_sample;
  ops.free = free_message;
  ops.print = print;
  ops.get_keyhash = key_hash;
  return ops;
}

/// Without those for samples of C structs, which only dds_read, dds_take and shared memory ask.
ddsi_sertype_ops type_operations() {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = free_type;
  ops.equal = same_type;
  ops.hash = hash_of_type;
  return ops;
}

const ddsi_serdata_ops kMessage = message_operations();
const ddsi_sertype_ops kType = type_operations();

}  // namespace

ddsi_sertype* new_blob_type(const char* type_on_wire) {
  auto* const type = new ddsi_sertype{};
  ddsi_sertype_init_flags(type, type_on_wire, &kType, &kMessage, DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type;
}

ddsi_serdata* new_message(const ddsi_sertype* type, ros::Blob cdr) {
  return make(type, SDK_DATA, std::move(cdr));
}

ros::Blob blob_of(const ddsi_serdata* message) {
  return of(message).cdr;
}

std::int64_t sequence_of(const ddsi_serdata* message) {
  return of(message).sequence;
}

}  // namespace gvom::dds
