#include "tests/bridge/mcap_file.hpp"

#include <zlib.h>
#include <zstd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <iterator>

namespace gvom::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
const Bytes kMagic = {0x89, 0x4D, 0x43, 0x41, 0x50, 0x30, 0x0D, 0x0A};

std::uint32_t crc_of(const Bytes& bytes, std::size_t begin, std::size_t end) {
  return static_cast<std::uint32_t>(::crc32(0, bytes.data() + begin, static_cast<uInt>(end - begin)));
}

class Fields {
 public:
  explicit Fields(const Bytes& bytes, std::size_t at = 0) : bytes_(bytes), at_(at) {}
  template <typename T>
  T number() {
    REQUIRE(at_ + sizeof(T) <= bytes_.size());
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  Bytes take(std::uint64_t size) {
    REQUIRE(size <= bytes_.size() - at_);
    const auto from = bytes_.begin() + static_cast<std::ptrdiff_t>(at_);
    at_ += size;
    return {from, from + static_cast<std::ptrdiff_t>(size)};
  }
  std::string text() {
    const Bytes taken = take(number<std::uint32_t>());
    return {taken.begin(), taken.end()};
  }
  [[nodiscard]] bool done() const { return at_ == bytes_.size(); }
  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

 private:
  const Bytes& bytes_;
  std::size_t at_;
};

class McapReading {
 public:
  explicit McapReading(Bytes bytes) : bytes_(std::move(bytes)) {}

  McapFile read() {
    Fields fields(bytes_);
    REQUIRE(fields.take(8) == kMagic);
    while (fields.left() >= 9) {
      const std::size_t begin = fields.at();
      if (file_.finished) break;
      const auto opcode = fields.number<std::uint8_t>();
      const auto length = fields.number<std::uint64_t>();
      if (length > fields.left()) {
        file_.bytes_behind = bytes_.size() - begin;
        return file_;
      }
      take(opcode, fields.take(length), begin);
    }
    if (file_.finished) REQUIRE(fields.take(8) == kMagic);
    file_.bytes_behind = fields.left();
    return file_;
  }

 private:
  void take(std::uint8_t opcode, const Bytes& body, std::size_t begin) {
    Fields fields(body);
    if (opcode == 1) file_.profile = fields.text();
    if (opcode == 2) take_footer(fields, begin);
    if (opcode == 3) take_schema(fields);
    if (opcode == 4) take_channel(fields);
    if (opcode == 6) take_chunk(fields, begin);
    if (opcode == 7) ++message_indexes_[begin];
    if (opcode == 8) take_chunk_index(fields);
    if (opcode == 11) file_.counted = fields.number<std::uint64_t>();
    if (opcode == 15) REQUIRE(fields.number<std::uint32_t>() == crc_of(bytes_, 0, begin));
    if (opcode == 15) summary_ = begin + 9 + 4;
  }

  void take_footer(Fields& fields, std::size_t begin) {
    REQUIRE(fields.number<std::uint64_t>() == summary_);
    REQUIRE(fields.number<std::uint64_t>() <= begin);
    REQUIRE(fields.number<std::uint32_t>() == crc_of(bytes_, summary_, begin + 9 + 16));
    file_.finished = true;
  }

  void take_schema(Fields& fields) {
    const auto id = fields.number<std::uint16_t>();
    REQUIRE(id != 0);
    types_[id] = fields.text();
    REQUIRE(fields.text() == "ros2msg");
    file_.schemas[types_[id]] = fields.text();
    REQUIRE(fields.done());
  }

  void take_channel(Fields& fields) {
    const auto id = fields.number<std::uint16_t>();
    const auto schema = fields.number<std::uint16_t>();
    REQUIRE((schema == 0 || types_.count(schema) == 1));
    const std::string topic = fields.text();
    channels_[id] = {topic, schema == 0 ? "" : types_[schema]};
    const std::string encoding = fields.text();
    REQUIRE(encoding == (schema == 0 ? "json" : "cdr"));
    const Bytes map = fields.take(fields.number<std::uint32_t>());
    for (Fields pairs(map); !pairs.done();) {
      REQUIRE(pairs.text() == "offered_qos_profiles");
      file_.metadata[topic] = pairs.text();
    }
    REQUIRE(fields.done());
  }

  void take_chunk(Fields& fields, std::size_t begin) {
    const auto first_ns = fields.number<std::uint64_t>(), last_ns = fields.number<std::uint64_t>();
    Bytes records(fields.number<std::uint64_t>());
    const auto crc = fields.number<std::uint32_t>();
    const std::string packing = fields.text();
    const Bytes packed = fields.take(fields.number<std::uint64_t>());
    REQUIRE(fields.done());
    if (packing.empty()) records = packed;
    if (packing == "zstd")
      REQUIRE(ZSTD_decompress(records.data(), records.size(), packed.data(), packed.size()) ==
              records.size());
    REQUIRE(crc == crc_of(records, 0, records.size()));
    const std::size_t before = file_.messages.size();
    for (Fields inner(records); !inner.done();) {
      const auto opcode = inner.number<std::uint8_t>();
      const Bytes body = inner.take(inner.number<std::uint64_t>());
      opcode == 5 ? take_message(body) : take(opcode, body, 0);
    }
    for (std::size_t i = before; i < file_.messages.size(); ++i) {
      REQUIRE(file_.messages[i].log_ns >= first_ns);
      REQUIRE(file_.messages[i].log_ns <= last_ns);
    }
    ++file_.chunks;
    chunk_at_[begin] = file_.messages.size() - before;
  }

  void take_message(const Bytes& body) {
    Fields fields(body);
    const auto channel = fields.number<std::uint16_t>();
    REQUIRE(channels_.count(channel) == 1);
    REQUIRE(fields.number<std::uint32_t>() == sequence_[channel]++);
    const auto log_ns = fields.number<std::uint64_t>();
    REQUIRE(fields.number<std::uint64_t>() == log_ns);
    file_.messages.push_back(
        {channels_[channel].first, channels_[channel].second, log_ns, fields.take(fields.left())});
  }

  void take_chunk_index(Fields& fields) {
    fields.number<std::uint64_t>();
    fields.number<std::uint64_t>();
    const auto begin = fields.number<std::uint64_t>();
    REQUIRE(chunk_at_.count(begin) == 1);
    fields.number<std::uint64_t>();
    const Bytes map = fields.take(fields.number<std::uint32_t>());
    std::uint64_t indexed = 0;
    for (Fields pairs(map); !pairs.done();) {
      const auto channel = pairs.number<std::uint16_t>();
      indexed += check_message_index(channel, pairs.number<std::uint64_t>());
    }
    REQUIRE(indexed == chunk_at_[begin]);
    ++file_.indexed_chunks;
  }

  std::uint64_t check_message_index(std::uint16_t channel, std::uint64_t begin) {
    REQUIRE(message_indexes_.count(begin) == 1);
    Fields fields(bytes_, begin + 9);
    REQUIRE(fields.number<std::uint16_t>() == channel);
    return fields.number<std::uint32_t>() / 16;
  }

  Bytes bytes_;
  McapFile file_;
  std::size_t summary_ = 0;
  std::map<std::uint16_t, std::string> types_;
  std::map<std::uint16_t, std::pair<std::string, std::string>> channels_;  // topic, type
  std::map<std::uint16_t, std::uint32_t> sequence_;
  std::map<std::size_t, std::size_t> chunk_at_;         // offset: messages
  std::map<std::size_t, std::size_t> message_indexes_;  // offsets
};

}  // namespace

McapFile read_mcap(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  INFO(path);
  REQUIRE(file.good());
  return McapReading(Bytes(std::istreambuf_iterator<char>(file), {})).read();
}

}  // namespace gvom::test
