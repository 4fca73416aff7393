#include "services/ingest/pcd.hpp"

#include <liblzf/lzf.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string_view>
#include <type_traits>

#include "services/ingest/bytes.hpp"

namespace gvom::ingest {
namespace {

constexpr std::size_t kMaxPointBytes = 4096;
constexpr std::size_t kMaxPoints = std::size_t{1} << 28;
constexpr std::size_t kMaxLzfRatio = 128;  // more than LZF can reach

struct Header {
  PcdCloud cloud;
  std::optional<std::size_t> width, height, points;
  std::size_t point_bytes = 0;
  std::size_t values = 0;  // numbers a point
  std::string data;        // ascii, binary, binary_compressed
  std::size_t lines = 0;
  std::size_t body_at = 0;
};

template <typename T>
tl::expected<std::vector<T>, std::string> words(std::istringstream& line, const std::string& key) {
  std::vector<T> out;
  for (T value; line >> value;) out.push_back(value);
  if (!line.eof() || out.empty()) return tl::unexpected(key + ": not the values that are expected");
  return out;
}

template <typename T, typename Set>
tl::expected<void, std::string> for_fields(std::istringstream& line, const std::string& key, Header& header,
                                           Set set) {
  const auto values = words<T>(line, key);
  if (!values) return tl::unexpected(values.error());
  auto& fields = header.cloud.fields;
  if (key == "FIELDS") fields.resize(values->size());
  if (values->size() != fields.size()) return tl::unexpected(key + ": not as many as FIELDS");
  for (std::size_t i = 0; i < fields.size(); ++i) set(fields[i], (*values)[i]);
  return {};
}

tl::expected<void, std::string> read_size(std::istringstream& line, const std::string& key,
                                          std::optional<std::size_t>& size) {
  const auto values = words<std::size_t>(line, key);
  if (!values || (*values)[0] > kMaxPoints) return tl::unexpected(key + ": not a sane number");
  size = (*values)[0];
  return {};
}

tl::expected<void, std::string> read_header_line(const std::string& text, Header& header) {
  std::istringstream line(text);
  std::string key;
  line >> key;
  using Word = std::string;
  if (key == "FIELDS")
    return for_fields<Word>(line, key, header, [](PcdField& f, const Word& w) { f.name = w; });
  if (key == "SIZE")
    return for_fields<std::size_t>(line, key, header, [](PcdField& f, std::size_t v) { f.size = v; });
  if (key == "TYPE") return for_fields<char>(line, key, header, [](PcdField& f, char v) { f.type = v; });
  if (key == "COUNT") {
    return for_fields<std::size_t>(line, key, header, [](PcdField& f, std::size_t v) { f.count = v; });
  }
  if (key == "WIDTH") return read_size(line, key, header.width);
  if (key == "HEIGHT") return read_size(line, key, header.height);
  if (key == "POINTS") return read_size(line, key, header.points);
  if (key == "DATA") line >> header.data;
  return {};
}

tl::expected<void, std::string> count_points(Header& header) {
  const std::size_t height = header.height.value_or(1);
  if (!header.points && !header.width) return tl::unexpected(std::string("neither POINTS nor WIDTH"));
  const std::size_t points = header.width ? *header.width * height : *header.points;
  if (header.points && *header.points != points) {
    return tl::unexpected("POINTS is " + std::to_string(*header.points) + ", WIDTH * HEIGHT " +
                          std::to_string(points));
  }
  if (points > kMaxPoints) return tl::unexpected(std::string("more points than 2^28"));
  header.cloud.points = points;
  header.cloud.height = height;
  return {};
}

tl::expected<void, std::string> check_fields(Header& header) {
  if (header.cloud.fields.empty()) return tl::unexpected(std::string("no FIELDS"));
  for (PcdField& field : header.cloud.fields) {
    const bool real = field.type == 'F' && (field.size == 4 || field.size == 8);
    const bool whole = (field.type == 'I' || field.type == 'U') &&
                       (field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8);
    if ((!real && !whole) || field.count > kMaxPointBytes) {
      return tl::unexpected("field '" + field.name + "': TYPE, SIZE or COUNT that PCD does not have");
    }
    field.offset = header.point_bytes;
    header.point_bytes += field.size * field.count;
    header.values += field.count;
    if (header.point_bytes > kMaxPointBytes)
      return tl::unexpected(std::string("points of more than 4096 bytes"));
  }
  if (header.point_bytes == 0) return tl::unexpected(std::string("points of no bytes"));
  auto& fields = header.cloud.fields;  // one with COUNT 0 has no value to read
  fields.erase(std::remove_if(fields.begin(), fields.end(), [](const PcdField& f) { return f.count == 0; }),
               fields.end());
  for (PcdField& field : header.cloud.fields) field.stride = header.point_bytes;
  return {};
}

tl::expected<Header, std::string> read_header(std::string_view file) {
  Header header;
  std::size_t at = 0;
  while (header.data.empty()) {
    const std::size_t end = file.find('\n', at);
    if (end == std::string_view::npos || end - at > 65536)
      return tl::unexpected(std::string("no DATA line: not a PCD file"));
    ++header.lines;
    const auto read = read_header_line(std::string(file.substr(at, end - at)), header);
    if (!read) return tl::unexpected("line " + std::to_string(header.lines) + ": " + read.error());
    at = end + 1;
  }
  header.body_at = at;
  auto checked = check_fields(header);
  if (checked) checked = count_points(header);
  if (!checked) return tl::unexpected(checked.error());
  return header;
}

template <typename T>
bool store_number(std::string_view word, std::uint8_t* to) {
  T value{};
  const char* end = word.data() + word.size();
  const auto parsed = std::from_chars(word.data(), end, value);
  if (parsed.ec != std::errc{} || parsed.ptr != end) return false;
  std::memcpy(to, &value, sizeof value);
  return true;
}

bool store_word(const PcdField& field, std::string_view word, std::uint8_t* to) {
  switch (field.type) {
    case 'F':
      return field.size == 4 ? store_number<float>(word, to) : store_number<double>(word, to);
    case 'U':
      if (field.size == 8) return store_number<std::uint64_t>(word, to);
      if (field.size == 4) return store_number<std::uint32_t>(word, to);
      return field.size == 2 ? store_number<std::uint16_t>(word, to) : store_number<std::uint8_t>(word, to);
    default:
      if (field.size == 8) return store_number<std::int64_t>(word, to);
      if (field.size == 4) return store_number<std::int32_t>(word, to);
      return field.size == 2 ? store_number<std::int16_t>(word, to) : store_number<std::int8_t>(word, to);
  }
}

constexpr char kBlanks[] = " \t\r";

std::string_view next_word(std::string_view& text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

tl::expected<void, std::string> store_row(const Header& header, std::string_view row, std::uint8_t* to) {
  for (const PcdField& field : header.cloud.fields) {
    for (std::size_t i = 0; i < field.count; ++i, to += field.size) {
      const std::string_view word = next_word(row);
      if (word.empty() || !store_word(field, word, to))
        return tl::unexpected(field.name + " is '" + std::string(word) + "'");
    }
  }
  if (const std::string_view word = next_word(row); !word.empty())
    return tl::unexpected("more than " + std::to_string(header.values) +
                          " numbers, FIELDS and COUNT have no '" + std::string(word) + "'");
  return {};
}

/// A point a line; blank lines are none.
tl::expected<void, std::string> unpack_ascii(Header& header, std::string_view text,
                                             std::vector<std::uint8_t>& out) {
  const std::size_t points = header.cloud.points;
  if (points * header.values > text.size())
    return tl::unexpected(std::string("fewer points than POINTS says"));
  out.resize(points * header.point_bytes);
  std::size_t rows = 0;
  for (std::size_t line = header.lines + 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view row = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (row.find_first_not_of(kBlanks) == std::string_view::npos) continue;
    if (rows < points) {
      const auto stored = store_row(header, row, out.data() + rows * header.point_bytes);
      if (!stored) return tl::unexpected("line " + std::to_string(line) + ": " + stored.error());
    }
    ++rows;
  }
  if (rows < points)
    return tl::unexpected("holds " + std::to_string(rows) + " of its " + std::to_string(points) + " points");
  header.cloud.more_points = rows - points;
  return {};
}

/// Unpacks to one array a field.
tl::expected<void, std::string> unpack_lzf(Header& header, Bytes body, std::vector<std::uint8_t>& out) {
  const std::size_t bytes = header.cloud.points * header.point_bytes;
  if (body.size < 8) return tl::unexpected(std::string("cut off by the end of the file"));
  const std::size_t packed = load_le<std::uint32_t>(body.data);
  const std::size_t unpacked = load_le<std::uint32_t>(body.data + 4);
  if (packed > body.size - 8) return tl::unexpected(std::string("cut off by the end of the file"));
  if (unpacked != bytes || unpacked > packed * kMaxLzfRatio) {
    return tl::unexpected("unpacks to " + std::to_string(unpacked) + " bytes, not the " +
                          std::to_string(bytes) + " of its points");
  }
  out.resize(bytes);
  const unsigned done =
      lzf_decompress(body.data + 8, static_cast<unsigned>(packed), out.data(), static_cast<unsigned>(bytes));
  if (done != bytes) return tl::unexpected(std::string("the compressed data are corrupt"));
  for (PcdField& field : header.cloud.fields) {
    field.offset *= header.cloud.points;
    field.stride = field.size * field.count;
  }
  return {};
}

template <typename To>
To read_value(const PcdField& field, const std::uint8_t* at) {
  const auto as = [at](auto type) { return static_cast<To>(load_le<decltype(type)>(at)); };
  if (field.type == 'F') return field.size == 4 ? as(float{}) : as(double{});
  if (field.type == 'U') {
    if (field.size == 8) return as(std::uint64_t{});
    if (field.size == 4) return as(std::uint32_t{});
    return field.size == 2 ? as(std::uint16_t{}) : as(std::uint8_t{});
  }
  if (field.size == 8) return as(std::int64_t{});
  if (field.size == 4) return as(std::int32_t{});
  return field.size == 2 ? as(std::int16_t{}) : as(std::int8_t{});
}

}  // namespace

const PcdField* PcdCloud::find(const std::string& name) const {
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const PcdField& f) { return f.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

double PcdCloud::number(const PcdField& field, std::size_t point) const {
  return read_value<double>(field, body.data + field.offset + point * field.stride);
}

std::int64_t PcdCloud::integer(const PcdField& field, std::size_t point) const {
  return read_value<std::int64_t>(field, body.data + field.offset + point * field.stride);
}

tl::expected<PcdCloud, std::string> parse_pcd(Bytes file, std::vector<std::uint8_t>& scratch) {
  const std::string_view text(reinterpret_cast<const char*>(file.data), file.size);
  auto header = read_header(text);
  if (!header) return tl::unexpected(header.error());
  const Bytes body{file.data + header->body_at, file.size - header->body_at};
  tl::expected<void, std::string> unpacked;
  if (header->data == "binary") {
    if (body.size < header->cloud.points * header->point_bytes) {
      return tl::unexpected("holds " + std::to_string(body.size / header->point_bytes) + " of its " +
                            std::to_string(header->cloud.points) + " points");
    }
    header->cloud.more_points = body.size / header->point_bytes - header->cloud.points;
  } else if (header->data == "ascii") {
    unpacked = unpack_ascii(*header, text.substr(header->body_at), scratch);
  } else if (header->data == "binary_compressed") {
    unpacked = unpack_lzf(*header, body, scratch);
  } else {
    return tl::unexpected("DATA " + header->data + " is not known (ascii, binary, binary_compressed)");
  }
  if (!unpacked) return tl::unexpected(unpacked.error());
  header->cloud.body = header->data == "binary" ? body : Bytes{scratch.data(), scratch.size()};
  return std::move(header->cloud);
}

}  // namespace gvom::ingest
