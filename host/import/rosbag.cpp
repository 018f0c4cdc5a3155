// Bags that ROS 2 stores in SQLite (.db3), with the tables of rosbag2_storage_sqlite3.
#include <fmt/format.h>
#include <sqlite3.h>

#include <filesystem>
#include <map>

#include "host/exit_codes.hpp"
#include "host/import/confined_reader.hpp"
#include "host/import/joint_states.hpp"
#include "host/import/log_file.hpp"
#include "host/import/reader_library.hpp"
#include "host/input_limits.hpp"

namespace host {

namespace {

struct SqliteLibrary {
  explicit SqliteLibrary(const ReaderLibrary& library) {
    library.find(open, "sqlite3_open_v2");
    library.find(close, "sqlite3_close");
    library.find(execute, "sqlite3_exec");
    library.find(limit, "sqlite3_limit");
    library.find(prepare, "sqlite3_prepare_v2");
    library.find(step, "sqlite3_step");
    library.find(finish, "sqlite3_finalize");
    library.find(integer, "sqlite3_column_int64");
    library.find(text, "sqlite3_column_text");
    library.find(blob, "sqlite3_column_blob");
    library.find(size, "sqlite3_column_bytes");
    library.find(message, "sqlite3_errmsg");
  }

  decltype(&sqlite3_open_v2) open = nullptr;
  decltype(&sqlite3_close) close = nullptr;
  decltype(&sqlite3_exec) execute = nullptr;
  decltype(&sqlite3_limit) limit = nullptr;
  decltype(&sqlite3_prepare_v2) prepare = nullptr;
  decltype(&sqlite3_step) step = nullptr;
  decltype(&sqlite3_finalize) finish = nullptr;
  decltype(&sqlite3_column_int64) integer = nullptr;
  decltype(&sqlite3_column_text) text = nullptr;
  decltype(&sqlite3_column_blob) blob = nullptr;
  decltype(&sqlite3_column_bytes) size = nullptr;
  decltype(&sqlite3_errmsg) message = nullptr;
};

const SqliteLibrary& sqlite_library() {
  static const SqliteLibrary library{ReaderLibrary("ROS 2 bags", kSqlite)};
  return library;
}

/// URI of a file that SQLite opens as immutable, so without locks and without a journal beside it.
std::string uri_of(const std::string& path) {
  std::string address = "file:";
  for (const char c : path)
    address +=
        c == '?' || c == '#' || c == '%' ? fmt::format("%{:02X}", static_cast<unsigned char>(c)) : std::string(1, c);
  return address + "?immutable=1";
}

class RosbagReader {
 public:
  explicit RosbagReader(const std::string& path) : path_(path), sqlite_(sqlite_library()) {
    constexpr int kLargestMessage = 64 << 20;
    if (sqlite_.open(uri_of(path).c_str(), &file_, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX,
                     nullptr) != SQLITE_OK)
      fail();
    sqlite_.limit(file_, SQLITE_LIMIT_LENGTH, kLargestMessage);
    sqlite_.execute(file_, "PRAGMA trusted_schema=OFF; PRAGMA temp_store=MEMORY; PRAGMA mmap_size=0", nullptr, nullptr,
                    nullptr);
  }
  RosbagReader(const RosbagReader&) = delete;
  RosbagReader& operator=(const RosbagReader&) = delete;
  ~RosbagReader() { sqlite_.close(file_); }

  Log read() {
    std::int64_t size = 1;
    for (const char* const factor : {"PRAGMA page_size", "PRAGMA page_count"})
      each_row(factor, [&](sqlite3_stmt* row) { size *= sqlite_.integer(row, 0); });
    if (std::filesystem::file_size(path_) <
        static_cast<std::uintmax_t>(size))  // the library would read zeros after the end
      throw Failure(ExitCode::bad_input, fmt::format("{}: cut off; copy the bag again", path_));
    std::map<std::int64_t, BagTopic> topics;
    each_row("SELECT id, name, type, serialization_format FROM topics", [&](sqlite3_stmt* row) {
      topics[sqlite_.integer(row, 0)] = {text(row, 1), text(row, 2), text(row, 3)};
    });
    JointStates joints(path_);
    for (const auto& [id, topic] : topics)
      if (topic.has_joint_states())
        each_row(
            fmt::format("SELECT timestamp, data FROM messages WHERE topic_id = {} ORDER BY timestamp, id", id),
            [&, &name = topic.name](sqlite3_stmt* row) {
              const void* const data = sqlite_.blob(row, 1);
              const auto size = static_cast<std::size_t>(sqlite_.size(row, 1));
              joints.add(name, {static_cast<const char*>(data), data != nullptr ? size : 0}, sqlite_.integer(row, 0));
            });
    std::vector<BagTopic> held;
    for (const auto& [id, topic] : topics) held.push_back(topic);
    return joints.log(held);
  }

 private:
  [[noreturn]] void fail() const {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: no ROS 2 bag that can be read ({}); mend a bag with sqlite3 FILE .recover, export the "
                    "tables of another database as CSV",
                    path_, sqlite_.message(file_)));
  }

  template <typename Take>
  void each_row(const std::string& query, const Take& take) const {
    sqlite3_stmt* statement = nullptr;
    if (sqlite_.prepare(file_, query.c_str(), -1, &statement, nullptr) != SQLITE_OK) fail();
    int state = SQLITE_ROW;
    while ((state = sqlite_.step(statement)) == SQLITE_ROW) take(statement);
    if (state != SQLITE_DONE) fail();
    sqlite_.finish(statement);
  }

  std::string text(sqlite3_stmt* row, int column) const {
    const unsigned char* const bytes = sqlite_.text(row, column);
    return bytes != nullptr ? reinterpret_cast<const char*>(bytes) : "";
  }

  std::string path_;
  const SqliteLibrary& sqlite_;
  sqlite3* file_ = nullptr;
};

}  // namespace

Log read_rosbag(const std::string& path) {
  sqlite_library();
  std::error_code none;
  if (const auto size = std::filesystem::file_size(path + "-wal", none); !none && size > 0)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{0}: the bag was not closed, its last messages are in {0}-wal; bring "
                              "them in: sqlite3 {0} 'PRAGMA wal_checkpoint(TRUNCATE)'",
                              path));
  return read_confined(path, kSqlite.file, [](const std::string& file) { return RosbagReader(file).read(); });
}

}  // namespace host
