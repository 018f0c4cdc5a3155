// A program that waits for its operator at a stop (M0, M1): shown to the user's other programs, which may continue it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace host {

/// The notice is a file in a folder that belongs to the user alone. Its owner holds a lock on it, so that the notice of
/// a killed program is recognised. Continuing is a word in that file: a removed or a left-over file continues nothing.
class StopNotice {
 public:
  /// Without a folder of the user (own_folder()) nobody else sees the stop.
  StopNotice(const std::string& program, std::size_t line);
  StopNotice(const StopNotice&) = delete;
  StopNotice& operator=(const StopNotice&) = delete;
  ~StopNotice();

  /// Another program of the user has called continue_program().
  bool is_continued() const;

 private:
  std::string path_;
  int file_ = -1;
  std::size_t size_ = 0;  ///< bytes of the notice, before the word
};

struct WaitingProgram {
  std::string id;       ///< of this stop
  std::string program;  ///< file, as given to `run`
  std::size_t line = 0;
};

/// Programs of this user that wait now.
std::vector<WaitingProgram> waiting_programs();

/// Lets the program pass this stop; it checks its axes first. Throws Failure(refused) if it no longer waits there.
void continue_program(const std::string& id);

}  // namespace host
