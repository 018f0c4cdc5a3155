// Work on several cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "host/cancellation.hpp"

namespace host {

/// Calls work(index) for 0 ... count-1 on all cores, in no particular order; the first exception is rethrown in this
/// thread. Cancelling this thread cancels all calls.
template <typename Work>
void for_each_in_parallel(std::size_t count, Work work) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_lock;
  const auto worker = [&, flag = cancel_flag()] {
    const CancelledBy scope(flag);
    for (std::size_t index = next++; index < count; index = next++) {
      try {
        throw_if_cancelled();
        work(index);
      } catch (...) {
        const std::lock_guard lock(failure_lock);
        if (!failure) failure = std::current_exception();
      }
    }
  };
  const std::size_t threads = std::min<std::size_t>(count, std::max(1U, std::thread::hardware_concurrency()));
  std::vector<std::jthread> pool;
  for (std::size_t k = 1; k < threads; ++k) pool.emplace_back(worker);
  worker();
  pool.clear();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace host
