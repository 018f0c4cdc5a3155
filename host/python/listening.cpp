#include "host/python/listening.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <exception>
#include <mutex>

#include "host/cancellation.hpp"

namespace axistool_python {

namespace py = pybind11;

namespace {

/// Short enough for Ctrl-C to respond at once, long enough to cost no time.
constexpr std::chrono::milliseconds kInterval{50};

class Listener {
 public:
  Listener(const py::object& progress, const std::string& what) : progress_(progress), what_(what) {}

  void run(const std::function<void(const Told&)>& work) {
    std::thread worker = quiet_thread([&] { carry_out(work); });
    {
      const py::gil_scoped_release released;
      wait();
      worker.join();
    }
    if (!raised_) tell();
    if (raised_) std::rethrow_exception(raised_);
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  /// Runs in the worker thread.
  void carry_out(const std::function<void(const Told&)>& work) {
    const host::CancelledBy scope(&cancelled_);
    try {
      work([this](double share) {
        host::throw_if_cancelled();
        const std::lock_guard lock(mutex_);
        share_ = std::max(share_, share);
      });
    } catch (...) {
      thrown_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_one();
  }

  void wait() {
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, kInterval, [this] { return ended_; })) {
      lock.unlock();
      if (!raised_) {
        const py::gil_scoped_acquire held;
        tell();
      }
      lock.lock();
    }
  }

  /// Handles signals, and reports new progress. Needs Python's lock.
  void tell() {
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      double share = 0.0;
      {
        const std::lock_guard lock(mutex_);
        share = share_;
      }
      if (!progress_.is_none() && share > told_) progress_(share, what_);
      told_ = share;
    } catch (py::error_already_set&) {
      raised_ = std::current_exception();
      cancelled_ = true;
    }
  }

  const py::object& progress_;
  const std::string& what_;
  std::atomic<bool> cancelled_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  double share_ = 0.0, told_ = 0.0;
  bool ended_ = false;
  std::exception_ptr raised_, thrown_;  ///< exceptions of Python, and of the work
};

}  // namespace

std::thread quiet_thread(std::function<void()> work) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);  // the new thread inherits this mask
  std::thread thread(std::move(work));
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

void listen_while(const py::object& progress, const std::string& what, const std::function<void(const Told&)>& work) {
  Listener(progress, what).run(work);
}

}  // namespace axistool_python
