// Runs long work without Python's lock, while the caller's thread handles Ctrl-C.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>
#include <string>
#include <thread>

namespace axistool_python {

/// Receives the finished share of the work, 0..1, from any thread (host::ShareDone).
using Told = std::function<void(double)>;

/// A thread with all signals blocked, so that Python's thread handles them.
std::thread quiet_thread(std::function<void()> work);

/// Runs `work` in a separate thread. Meanwhile, in the caller's thread, calls `progress` (a callable of share and
/// `what`, or None) and lets Python handle signals. An exception of either cancels the work and is rethrown; otherwise
/// an exception of the work is rethrown.
void listen_while(const pybind11::object& progress, const std::string& what,
                  const std::function<void(const Told&)>& work);

/// The same with a result.
template <typename Work>
auto result_of(const pybind11::object& progress, const std::string& what, Work work) {
  std::optional<decltype(work(Told{}))> result;
  listen_while(progress, what, [&](const Told& done) { result.emplace(work(done)); });
  return *std::move(result);
}

}  // namespace axistool_python
