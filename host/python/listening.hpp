// Long work beside the interpreter: it goes on without Python's lock, while the caller's thread hears Ctrl-C.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>
#include <string>
#include <thread>

namespace axistool_python {

/// Takes the share of the work that is done, 0..1, from any thread (host::ShareDone).
using Told = std::function<void(double)>;

/// A thread that no signal interrupts: they are for Python's.
std::thread quiet_thread(std::function<void()> work);

/// Runs `work` in a thread of its own. Meanwhile tells `progress` (a callable of share and `what`, or None), in the
/// caller's thread, how far it is, and lets Python handle signals. What either raises cancels the work and comes out of
/// here; else what the work throws does.
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
