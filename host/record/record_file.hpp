// A record's file as blocks of lines, for readers that do not hold the whole record in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace host {

/// What tells one content of a file from another.
struct FileStamp {
  std::uint64_t device = 0, inode = 0, bytes = 0;
  std::int64_t modified_s = 0, modified_ns = 0;
  bool operator==(const FileStamp&) const = default;
};

/// Throws Failure(bad_input) if there is no such file.
FileStamp file_stamp(const std::string& path);

/// Reads while the file keeps its size and time of change. Safe to use from several threads.
class RecordFile {
 public:
  static constexpr std::size_t kBlock = std::size_t{1} << 18U;

  /// A row: its number in sample periods from the first stamp, and the other columns; NaN where there is no number.
  using Row = std::function<void(std::uint64_t number, std::span<const double> values)>;

  struct Faults {
    std::uint64_t rows = 0;    ///< lines with too few or too many fields, or with a time that does not fit the record
    std::uint64_t fields = 0;  ///< fields that are not finite numbers
  };

  /// Reads the header and the first and last rows. Throws Failure(bad_input) with the line and a remedy if it cannot:
  /// no t_s among the columns, no other column, too few rows, no sample period, or a file above a limit.
  explicit RecordFile(const std::string& path);
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;
  ~RecordFile();

  const FileStamp& stamp() const { return stamp_; }
  const std::vector<std::string>& columns() const { return columns_; }  ///< without t_s
  double start_s() const { return start_s_; }                           ///< first stamp
  double period_s() const { return period_s_; }                         ///< sample period
  std::uint64_t rows() const { return rows_; }                          ///< number of the last row, plus one
  const std::string& head() const { return head_; }                     ///< text above the rows
  std::size_t blocks() const;

  /// The lines that begin in a block. Throws Failure(bad_input) if the file has changed or a line is too long.
  std::string block(std::size_t index) const;

  /// Gives the rows of lines to `take`, in their order.
  Faults each_row(std::string_view lines, const Row& take) const;

 private:
  void read_head();
  void read_time_base();
  std::string bytes(std::uint64_t begin, std::size_t size) const;
  bool take_fields(std::string_view line, double& t_s, std::vector<double>& values) const;
  double time_of(std::string_view line) const;

  std::string path_, head_;
  int file_ = -1;
  FileStamp stamp_;
  std::vector<std::string> columns_;
  std::size_t time_column_ = 0;
  double header_period_s_ = 0.0, start_s_ = 0.0, period_s_ = 0.0;
  std::uint64_t rows_ = 0;
};

}  // namespace host
