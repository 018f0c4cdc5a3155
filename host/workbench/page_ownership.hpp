// Which page commands the axes: one at a time, and only while it shows that it is there.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

namespace host::workbench {

class PageOwnership {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Silence after which a page no longer commands. A page beats every 0.1 s; a sleeping tab beats once a second.
  static constexpr std::chrono::milliseconds kSilence{500};

  /// The key of a new owner. Throws Failure(refused) while another page commands.
  std::string claim(Time now);

  /// A sign of life. Throws as require() does.
  void beat(const std::string& key, Time now);

  /// Throws Failure(refused) if this is not the key of the owner, or if the owner was silent for too long, even if it
  /// has beaten again.
  void require(const std::string& key, Time now) const;

  /// Whether require() would not throw.
  bool holds(const std::string& key, Time now) const;

  void drop();  ///< nobody commands
  bool is_there(Time now) const;

  /// The number of the present owner, counted from 1; 0: nobody commands. Pages may know it.
  std::size_t number(Time now) const;

 private:
  bool is_there_locked(Time now) const { return !key_.empty() && now - heard_ <= kSilence; }

  mutable std::mutex mutex_;
  std::string key_;
  Time heard_;
  std::size_t claims_ = 0;
};

}  // namespace host::workbench
