// Writes a capture to disk while it runs, so that its rows survive a crash of the program or a power failure.
#pragma once

#include <string>

#include "host/device/capture.hpp"

namespace host {

/// OUTPUT.unfinished: a record that is extended twice a second until the complete record replaces it.
class CaptureJournal {
 public:
  /// Nothing is written before the first row. `settings` outlives this.
  CaptureJournal(const std::string& output, const CaptureSettings& settings, std::string drive);
  CaptureJournal(const CaptureJournal&) = delete;
  CaptureJournal& operator=(const CaptureJournal&) = delete;
  ~CaptureJournal();

  /// Appends the new rows; if a trigger is set, only those from the trigger on. Throws Failure: permission, bad_input
  /// (disk full).
  void keep(const Capture& capture);

  /// Call it once the complete record is written.
  void remove();

  /// Describes the kept rows, for the message of a failure; empty if there are none.
  std::string remark() const;

 private:
  std::string path_, drive_;
  const CaptureSettings& settings_;
  int file_ = -1;
  std::size_t kept_ = 0;  ///< rows
};

}  // namespace host
