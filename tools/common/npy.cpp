#include "tools/common/npy.hpp"

#include <cctype>
#include <fstream>
#include <optional>

namespace gvom::npy {
namespace {

constexpr char kMagic[] = "\x93NUMPY";
constexpr std::size_t kMagicLength = 6;
constexpr std::size_t kHeaderAlignment = 64;

/// Bytes of a type code such as "<f4"; 0 if it is not a little-endian number.
std::size_t type_size(const std::string& type) {
  if (type.size() != 3 || std::string("iuf").find(type[1]) == std::string::npos) return 0;
  const bool byte_sized = type[2] == '1';
  if (type[0] != '<' && !(type[0] == '|' && byte_sized)) return 0;
  return std::string("1248").find(type[2]) == std::string::npos ? 0 : static_cast<std::size_t>(type[2] - '0');
}

std::size_t record_size_of(const std::vector<Field>& fields) {
  std::size_t sum = 0;
  for (const Field& field : fields) {
    const std::size_t size = type_size(field.type);
    if (size == 0) return 0;
    sum += size;
  }
  return sum;
}

std::size_t product(const std::vector<std::size_t>& shape) {
  std::size_t count = 1;
  for (const std::size_t extent : shape) count *= extent;
  return count;
}

bool is_plain(const std::vector<Field>& fields) {
  return fields.size() == 1 && fields[0].name.empty();
}

std::string header_text(const std::vector<std::size_t>& shape, const std::vector<Field>& fields) {
  std::string text = "{'descr': ";
  if (is_plain(fields)) {
    text += "'" + fields[0].type + "'";
  } else {
    text += "[";
    for (const Field& field : fields) {
      if (&field != &fields.front()) text += ", ";
      text += "('" + field.name + "', '" + field.type + "')";
    }
    text += "]";
  }
  text += ", 'fortran_order': False, 'shape': (";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += std::to_string(shape[i]) + (shape.size() == 1 ? "," : i + 1 < shape.size() ? ", " : "");
  text += "), }";
  const std::size_t used = kMagicLength + 4 + text.size() + 1;
  text.append((kHeaderAlignment - used % kHeaderAlignment) % kHeaderAlignment, ' ');
  return text + '\n';
}

/// Reads the Python literal of a header: nothing but what NumPy writes there.
class HeaderParser {
 public:
  explicit HeaderParser(const std::string& text) : text_(text) {}

  /// False if the text is not a dictionary of descr, fortran_order and shape.
  bool parse() {
    if (!take('{')) return false;
    while (!take('}')) {
      const auto key = quoted();
      if (!key || !take(':') || !value_of(*key)) return false;
      take(',');
    }
    return !fields.empty() && has_shape_ && has_order_;
  }

  std::vector<Field> fields;
  std::vector<std::size_t> shape;
  bool fortran_order = false;

 private:
  void skip_spaces() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }

  bool take(char c) {
    skip_spaces();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  bool take_word(const char* word) {
    skip_spaces();
    const std::size_t length = std::strlen(word);
    if (text_.compare(at_, length, word) != 0) return false;
    at_ += length;
    return true;
  }

  std::optional<std::string> quoted() {
    skip_spaces();
    if (at_ >= text_.size() || (text_[at_] != '\'' && text_[at_] != '"')) return std::nullopt;
    const std::size_t end = text_.find(text_[at_], at_ + 1);
    if (end == std::string::npos) return std::nullopt;
    std::string word = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return word;
  }

  bool value_of(const std::string& key) {
    if (key == "descr") return parse_type();
    if (key == "shape") return parse_shape();
    if (key != "fortran_order") return false;
    has_order_ = true;
    fortran_order = take_word("True");
    return fortran_order || take_word("False");
  }

  bool parse_type() {
    if (!take('[')) {
      const auto type = quoted();
      if (type) fields.push_back({"", *type});
      return type.has_value();
    }
    while (!take(']')) {
      if (!take('(')) return false;
      const auto name = quoted();
      if (!name || !take(',')) return false;
      const auto type = quoted();
      if (!type || !take(')')) return false;
      fields.push_back({*name, *type});
      take(',');
    }
    return true;
  }

  bool parse_shape() {
    has_shape_ = true;
    if (!take('(')) return false;
    while (!take(')')) {
      skip_spaces();
      std::size_t extent = 0;
      const std::size_t begin = at_;
      for (; at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_])); ++at_)
        extent = extent * 10 + static_cast<std::size_t>(text_[at_] - '0');
      if (at_ == begin || at_ - begin > 12) return false;
      shape.push_back(extent);
      take(',');
    }
    return true;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  bool has_shape_ = false;
  bool has_order_ = false;
};

/// The header's text and a stream that stands at the data; an error in words otherwise.
tl::expected<std::string, std::string> read_header(std::ifstream& file) {
  char start[kMagicLength + 2];
  if (!file.read(start, sizeof(start)) || std::memcmp(start, kMagic, kMagicLength) != 0)
    return tl::unexpected(std::string("not an .npy file"));
  const int version = start[kMagicLength];
  if (version < 1 || version > 3)
    return tl::unexpected("format version " + std::to_string(version) + " is not known");
  unsigned char bytes[4] = {};
  file.read(reinterpret_cast<char*>(bytes), version == 1 ? 2 : 4);
  const std::size_t length =
      bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::size_t>(bytes[3]) << 24;
  if (!file || length > 1'000'000) return tl::unexpected(std::string("the header is cut off or too long"));
  std::string text(length, '\0');
  if (!file.read(text.data(), static_cast<std::streamsize>(length)))
    return tl::unexpected(std::string("the header is cut off"));
  return text;
}

tl::expected<Array, std::string> read_array(std::ifstream& file) {
  const auto text = read_header(file);
  if (!text) return tl::unexpected(text.error());
  HeaderParser header(*text);
  if (!header.parse()) return tl::unexpected("the header is not understood: " + *text);
  if (header.fortran_order) return tl::unexpected(std::string("Fortran order is not supported"));
  Array array{header.shape, header.fields, {}};
  const std::size_t element_size = record_size_of(array.fields);
  if (element_size == 0) return tl::unexpected("type " + array.describe_type() + " is not supported");

  const auto begin = file.tellg();
  file.seekg(0, std::ios::end);
  const auto present = static_cast<std::size_t>(file.tellg() - begin);
  const std::size_t count = array.element_count();
  if (count > present / element_size || count * element_size != present)
    return tl::unexpected("has " + std::to_string(present) + " bytes of data, its shape needs " +
                          std::to_string(count) + " x " + std::to_string(element_size));
  file.seekg(begin);
  array.data.resize(present);
  if (!file.read(reinterpret_cast<char*>(array.data.data()), static_cast<std::streamsize>(present)))
    return tl::unexpected(std::string("cannot be read"));
  return array;
}

}  // namespace

std::size_t Array::element_count() const {
  return product(shape);
}

std::string Array::describe_type() const {
  if (is_plain(fields)) return fields[0].type;
  std::string text;
  for (const Field& field : fields) text += (text.empty() ? "" : ", ") + field.name + " " + field.type;
  return text;
}

tl::expected<void, std::string> write_npy_bytes(const std::string& path,
                                                const std::vector<std::size_t>& shape,
                                                const std::vector<Field>& fields, const void* data) {
  const std::size_t element_size = record_size_of(fields);
  if (element_size == 0) return tl::unexpected(path + ": a field's type is not supported");
  const std::string header = header_text(shape, fields);
  if (header.size() > 65535) return tl::unexpected(path + ": too many fields");
  std::ofstream file(path, std::ios::binary);
  const char prefix[4] = {1, 0, static_cast<char>(header.size() & 0xFF),
                          static_cast<char>(header.size() >> 8)};
  file.write(kMagic, kMagicLength);
  file.write(prefix, sizeof(prefix));
  file.write(header.data(), static_cast<std::streamsize>(header.size()));
  file.write(static_cast<const char*>(data), static_cast<std::streamsize>(product(shape) * element_size));
  file.close();
  if (!file) return tl::unexpected(path + ": cannot be written");
  return {};
}

tl::expected<void, std::string> write_npy_records(const std::string& path, const std::vector<Field>& fields,
                                                  std::size_t count, std::size_t record_size,
                                                  const void* data) {
  if (record_size_of(fields) != record_size)
    return tl::unexpected(path + ": a record of " + std::to_string(record_size) +
                          " bytes does not match its fields");
  return write_npy_bytes(path, {count}, fields, data);
}

tl::expected<Array, std::string> read_npy(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return tl::unexpected(path + ": cannot be opened");
  auto array = read_array(file);
  if (!array) return tl::unexpected(path + ": " + array.error());
  return array;
}

}  // namespace gvom::npy
