// Ending a long computation from outside: who runs it sets a flag, its fits look at it.
#pragma once

#include <atomic>
#include <exception>
#include <utility>

namespace host {

/// Thrown by a computation that finds itself cancelled.
struct Cancelled : std::exception {
  const char* what() const noexcept override { return "cancelled"; }
};

/// The flag of what this thread computes; none: it cannot be cancelled.
inline const std::atomic<bool>*& cancel_flag() {
  thread_local const std::atomic<bool>* flag = nullptr;
  return flag;
}

/// While it lives, what this thread computes ends with Cancelled soon after `flag` is set.
class CancelledBy {
 public:
  explicit CancelledBy(const std::atomic<bool>* flag) : before_(std::exchange(cancel_flag(), flag)) {}
  CancelledBy(const CancelledBy&) = delete;
  CancelledBy& operator=(const CancelledBy&) = delete;
  ~CancelledBy() { cancel_flag() = before_; }

 private:
  const std::atomic<bool>* before_;
};

inline bool is_cancelled() { return cancel_flag() != nullptr && *cancel_flag(); }

inline void throw_if_cancelled() {
  if (is_cancelled()) throw Cancelled();
}

}  // namespace host
