// A program that wants the board's one capture asks a workbench of the same user, which streams channels, for it.
#pragma once

#include <string>

namespace host {

/// A file in a folder that belongs to the user alone, which is locked for the lifetime of this object: that of a killed
/// program asks for nothing. Without such a folder nobody is asked.
class CaptureWish {
 public:
  explicit CaptureWish(const std::string& board);
  CaptureWish(const CaptureWish&) = delete;
  CaptureWish& operator=(const CaptureWish&) = delete;
  ~CaptureWish();

 private:
  int file_ = -1;
};

/// Whether a program wants to capture on this board now.
bool is_capture_wished(const std::string& board);

}  // namespace host
