// Pictures of any part of a long record, from a pyramid of envelopes that background threads make from its file.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "host/record/envelope_pyramid.hpp"
#include "host/record/record_file.hpp"

namespace host {

class RecordPicture {
 public:
  /// Largest number of buckets of one answer.
  static constexpr std::size_t kMostPoints = 4000;

  struct Progress {
    double share = 0.0;         ///< of the file that has been read, 0 to 1
    RecordFile::Faults faults;  ///< in that share; their rows and fields are not drawn
    std::string problem;        ///< reason why the reading ended early; empty if it did not
  };

  /// Reads the header, then the rows in the background: blocks spread evenly over the record first, so that an early
  /// picture shows all of it. Throws as RecordFile().
  explicit RecordPicture(const std::string& path);
  RecordPicture(const RecordPicture&) = delete;
  RecordPicture& operator=(const RecordPicture&) = delete;
  ~RecordPicture() = default;

  const RecordFile& file() const { return file_; }
  Progress progress() const;
  std::size_t bytes() const;  ///< memory that it takes

  /// Waits until all rows have been read, at most `longest_s`.
  void wait(double longest_s) const;

  /// The rows [from, to) in at most `points` + 2 buckets (`points` limited to kMostPoints) of 2^n rows. Rows that have
  /// not been read yet are missing. Throws Failure(bad_input) if rows have to be read from the file and it has changed.
  Envelope envelope(std::uint64_t from, std::uint64_t to, std::size_t points) const;

  /// The text of a record with the rows [from, to), and some beside them. Throws Failure: refused before all rows have
  /// been read, bad_input if the file has changed.
  std::string text_of(std::uint64_t from, std::uint64_t to) const;

 private:
  struct Block {
    std::uint64_t first = 1, last = 0;  ///< numbers of its rows; first > last: none, or not yet read
  };

  void read(const std::stop_token& stop);
  void read_block(std::size_t index);
  std::vector<std::size_t> blocks_of(std::uint64_t from, std::uint64_t to) const;

  RecordFile file_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  EnvelopePyramid pyramid_;
  std::vector<Block> blocks_;
  std::size_t read_ = 0;
  Progress progress_;
  std::jthread reader_;  ///< last member, because it uses the others
};

}  // namespace host
