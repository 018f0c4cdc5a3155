// A capture on disk while it runs: what has come is not lost with the program, or the computer's power.
#pragma once

#include <string>

#include "host/device/capture.hpp"

namespace host {

/// OUTPUT.unfinished: a record that grows twice a second, until the whole one takes its place.
class CaptureJournal {
 public:
  /// Nothing is written before there are rows. `settings` outlives this.
  CaptureJournal(const std::string& output, const CaptureSettings& settings, std::string drive);
  CaptureJournal(const CaptureJournal&) = delete;
  CaptureJournal& operator=(const CaptureJournal&) = delete;
  ~CaptureJournal();

  /// Appends the rows that have come since, from the trigger on where one is awaited. Throws Failure: permission,
  /// bad_input (disk full).
  void keep(const Capture& capture);

  /// The whole record is written.
  void remove();

  /// Names what is kept, for the message of a failure; empty: nothing.
  std::string remark() const;

 private:
  std::string path_, drive_;
  const CaptureSettings& settings_;
  int file_ = -1;
  std::size_t kept_ = 0;  ///< rows
};

}  // namespace host
