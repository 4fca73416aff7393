// MCAP files, whole, cut and damaged.
#include "services/common/mcap/mcap_reader.hpp"
#include "tests/fuzz/memory_file.hpp"

using namespace gvom;
using namespace gvom::fuzz;

namespace {

/// Messages up to the end or an error. One block's times are in order; its index may lie of others.
std::size_t count_messages(mcap::McapReader& reader) {
  std::size_t count = 0;
  for (mcap::Message message;; ++count) {
    const auto more = reader.next(message);
    if (!more || !*more) return count;
    require(message.channel != nullptr, "a message is of a channel");
    std::uint8_t sum = 0;  // reads all of it
    for (std::size_t i = 0; i < message.data.size; ++i)
      sum = static_cast<std::uint8_t>(sum + message.data.data[i]);
    require(sum <= 255, "a message can be read");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MemoryFile file;
  file.set(data, size);
  auto reader = mcap::McapReader::open(file.path());
  if (!reader) return 0;
  const std::size_t first = count_messages(*reader);
  const std::uint64_t damaged = reader->damaged();
  reader->rewind();
  require(count_messages(*reader) == first, "a file read again is the same");
  require(reader->damaged() == damaged, "what is damaged is counted once");
  reader->select({1});
  require(count_messages(*reader) <= first, "one channel has no more than all");
  return 0;
}
