#include "host/workbench/page_ownership.hpp"

#include "host/exit_codes.hpp"
#include "host/workbench/access.hpp"

namespace host::workbench {

std::string PageOwnership::claim(Time now) {
  const std::lock_guard lock(mutex_);
  if (is_there_locked(now)) throw Failure(ExitCode::refused, "another page commands the axes");
  key_ = random_token();
  heard_ = now;
  ++claims_;
  return key_;
}

void PageOwnership::beat(const std::string& key, Time now) {
  require(key, now);
  const std::lock_guard lock(mutex_);
  heard_ = now;
}

void PageOwnership::require(const std::string& key, Time now) const {
  if (!holds(key, now)) throw Failure(ExitCode::refused, "this page does not command the axes: take the command first");
}

bool PageOwnership::holds(const std::string& key, Time now) const {
  const std::lock_guard lock(mutex_);
  return is_there_locked(now) && key == key_;
}

void PageOwnership::drop() {
  const std::lock_guard lock(mutex_);
  key_.clear();
}

bool PageOwnership::is_there(Time now) const {
  const std::lock_guard lock(mutex_);
  return is_there_locked(now);
}

std::size_t PageOwnership::number(Time now) const {
  const std::lock_guard lock(mutex_);
  return is_there_locked(now) ? claims_ : 0;
}

}  // namespace host::workbench
