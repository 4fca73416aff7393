// rosbag2's SQLite files.
#include <sqlite3.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <utility>

#include "services/common/bag/bag_file.hpp"

namespace gvom::bag {
namespace {

constexpr std::size_t kMostTopics = 65536;

struct Close {
  void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Database = std::unique_ptr<sqlite3, Close>;
using Statement = std::unique_ptr<sqlite3_stmt, Close>;
using Result = tl::expected<void, std::string>;

std::string column_text(sqlite3_stmt* row, int column) {
  const auto* const text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return text == nullptr ? "" : text;
}

/// A path in an SQLite URI.
std::string escaped(const std::string& path) {
  std::string out;
  for (const char c : path) out += c == '%' ? "%25" : c == '?' ? "%3f" : c == '#' ? "%23" : std::string(1, c);
  return out;
}

class Db3File final : public BagFile {
 public:
  explicit Db3File(std::string name) : name_(std::move(name)) {}

  Result open(const std::string& path);

  [[nodiscard]] const std::vector<FileTopic>& topics() const override { return topics_; }
  [[nodiscard]] std::int64_t first_ns() const override { return first_ns_; }
  [[nodiscard]] std::int64_t last_ns() const override { return last_ns_; }
  Result select(const std::set<std::size_t>& topics) override;
  tl::expected<bool, std::string> next(FileMessage& out) override;
  [[nodiscard]] std::uint64_t damaged() const override { return 0; }
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return warnings_; }

 private:
  Result open_database(const std::string& path);
  Result open_with(const std::string& uri);
  Result read_topics();
  Result count_messages();
  tl::expected<Statement, std::string> prepare(const std::string& sql);
  [[nodiscard]] tl::unexpected<std::string> failure() const {
    return tl::unexpected(name_ + ": " + sqlite3_errmsg(database_.get()));
  }

  std::string name_;
  Database database_;
  Statement order_;    // which message comes when: row, topic, time
  Statement message_;  // the data of a row
  std::vector<FileTopic> topics_;
  std::map<std::int64_t, std::size_t> topic_of_id_;
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
  std::vector<std::string> warnings_;
};

Result Db3File::open_with(const std::string& uri) {
  sqlite3* database = nullptr;
  const int opened = sqlite3_open_v2(uri.c_str(), &database,
                                     SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
  database_.reset(database);
  if (opened != SQLITE_OK) return failure();
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH, static_cast<int>(kMostMessageBytes));
  sqlite3_exec(database, "PRAGMA trusted_schema=OFF; PRAGMA temp_store=MEMORY", nullptr, nullptr, nullptr);
  const auto tables =
      prepare("SELECT count(*) FROM sqlite_master WHERE type='table' AND name IN ('topics','messages')");
  if (!tables) return tl::unexpected(tables.error());
  if (sqlite3_step(tables->get()) != SQLITE_ROW) return failure();
  if (sqlite3_column_int(tables->get(), 0) != 2)
    return tl::unexpected(name_ + ": is no rosbag2 file: has no tables topics and messages");
  return {};
}

/// Where nothing can be written beside it, SQLite can't join in reading a file that has a -wal.
Result Db3File::open_database(const std::string& path) {
  auto opened = open_with("file:" + escaped(path) + "?mode=ro");
  const int code = sqlite3_errcode(database_.get());
  if (opened || (code != SQLITE_CANTOPEN && code != SQLITE_READONLY)) return opened;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return opened;
  opened = open_with("file:" + escaped(path) + "?immutable=1");
  const std::uintmax_t wal_bytes = std::filesystem::file_size(path + "-wal", error);
  if (opened && !error && wal_bytes > 0)
    warnings_.push_back(name_ + ": its recorder was killed, and the newest messages, in " + name_ +
                        "-wal, can't be read where nothing can be written: copy the bag elsewhere");
  return opened;
}

Result Db3File::open(const std::string& path) {
  auto done = open_database(path);
  if (done) done = read_topics();
  if (done) done = count_messages();
  return done;
}

tl::expected<Statement, std::string> Db3File::prepare(const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &statement, nullptr) != SQLITE_OK)
    return failure();
  return Statement(statement);
}

Result Db3File::read_topics() {
  const auto rows = prepare("SELECT id, name, type, serialization_format FROM topics");
  if (!rows) return tl::unexpected(rows.error());
  int step = SQLITE_ROW;
  while ((step = sqlite3_step(rows->get())) == SQLITE_ROW) {
    if (topics_.size() == kMostTopics) return tl::unexpected(name_ + ": has too many topics");
    topic_of_id_[sqlite3_column_int64(rows->get(), 0)] = topics_.size();
    topics_.push_back(
        {column_text(rows->get(), 1), column_text(rows->get(), 2), column_text(rows->get(), 3), 0});
  }
  if (step != SQLITE_DONE) return failure();
  return {};
}

Result Db3File::count_messages() {
  const auto rows =
      prepare("SELECT topic_id, count(*), min(timestamp), max(timestamp) FROM messages GROUP BY topic_id");
  if (!rows) return tl::unexpected(rows.error());
  bool any = false;
  int step = SQLITE_ROW;
  while ((step = sqlite3_step(rows->get())) == SQLITE_ROW) {
    const std::int64_t messages = sqlite3_column_int64(rows->get(), 1);
    const auto topic = topic_of_id_.find(sqlite3_column_int64(rows->get(), 0));
    if (topic == topic_of_id_.end()) {
      warnings_.push_back(name_ + ": " + std::to_string(messages) + " messages of no topic are left out");
      continue;
    }
    topics_[topic->second].messages = static_cast<std::uint64_t>(messages);
    const std::int64_t first_ns = sqlite3_column_int64(rows->get(), 2);
    const std::int64_t last_ns = sqlite3_column_int64(rows->get(), 3);
    first_ns_ = any ? std::min(first_ns_, first_ns) : first_ns;
    last_ns_ = any ? std::max(last_ns_, last_ns) : last_ns;
    any = true;
  }
  // A killed recorder's last pages may be missing: what is before them is read.
  if (step != SQLITE_DONE) warnings_.push_back(failure().value());
  return {};
}

Result Db3File::select(const std::set<std::size_t>& topics) {
  std::string ids;
  for (const auto& [id, topic] : topic_of_id_)
    if (topics.count(topic) != 0) ids += (ids.empty() ? "" : ",") + std::to_string(id);
  auto order = prepare("SELECT rowid, topic_id, timestamp FROM messages WHERE topic_id IN (" + ids +
                       ") ORDER BY timestamp, rowid");
  if (!order) return tl::unexpected(order.error());
  auto message = prepare("SELECT data FROM messages WHERE rowid = ?");
  if (!message) return tl::unexpected(message.error());
  order_ = std::move(*order);
  message_ = std::move(*message);
  return {};
}

tl::expected<bool, std::string> Db3File::next(FileMessage& out) {
  const int step = sqlite3_step(order_.get());
  if (step == SQLITE_DONE) return false;
  if (step != SQLITE_ROW) return failure();
  sqlite3_reset(message_.get());
  sqlite3_bind_int64(message_.get(), 1, sqlite3_column_int64(order_.get(), 0));
  if (sqlite3_step(message_.get()) != SQLITE_ROW) return failure();
  const auto* const data = static_cast<const std::uint8_t*>(sqlite3_column_blob(message_.get(), 0));
  const int bytes = sqlite3_column_bytes(message_.get(), 0);
  out = {topic_of_id_.at(sqlite3_column_int64(order_.get(), 1)),
         sqlite3_column_int64(order_.get(), 2),
         {data, data == nullptr ? 0 : static_cast<std::size_t>(bytes)}};
  return true;
}

}  // namespace

FileResult open_db3(const std::string& path, const std::string& name) {
  auto file = std::make_unique<Db3File>(name);
  const auto opened = file->open(path);
  if (!opened) return tl::unexpected(opened.error());
  return file;
}

}  // namespace gvom::bag
