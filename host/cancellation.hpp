// Cancels a long computation from outside: the caller sets a flag, which the fits check.
#pragma once

#include <atomic>
#include <exception>
#include <utility>

namespace host {

/// Thrown by a computation that was cancelled.
struct Cancelled : std::exception {
  const char* what() const noexcept override { return "cancelled"; }
};

/// The cancellation flag of this thread's computation; null if it cannot be cancelled.
inline const std::atomic<bool>*& cancel_flag() {
  thread_local const std::atomic<bool>* flag = nullptr;
  return flag;
}

/// During its lifetime, this thread's computation ends with Cancelled soon after `flag` is set.
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
