// The board behind the page: its channels, its parameters and its motion, by the functions of the commands.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "host/live/board_command.hpp"
#include "host/live/board_watch.hpp"
#include "host/workbench/folder.hpp"
#include "host/workbench/live_device.hpp"
#include "host/workbench/live_request.hpp"
#include "host/workbench/page_ownership.hpp"
#include "host/workbench/request.hpp"

namespace host::workbench {

/// Functions throw as the commands do. Those that command take the key of the page that does (PageOwnership).
class Live {
 public:
  Live(const Folder& folder, const LiveDevice& device);

  /// What does not change while one stream runs: axes with limits, all channels, those of the stream.
  nlohmann::json description() const;

  /// What changes: states of the axes, owner, counts of rows, trigger.
  nlohmann::json state() const;

  /// For `from`, `to` in rows and a number of points: { "first", "rows", "taken", "low", "high" }, channel by channel;
  /// null where no row arrived. `high` is left out for buckets of one row.
  nlohmann::json rows(const RowsRequest& range, std::size_t points) const;

  /// A page's view of the stream: the rows that it has, and their buckets.
  struct View {
    std::size_t rows = 1;    ///< of a bucket
    std::uint64_t back = 0;  ///< rows of the past, to begin with
    std::uint64_t epoch = 0, next = 0;
  };
  /// The complete buckets that have come since, as an event; "" if there is none.
  std::string next_event(View& view) const;

  std::string claim();
  void beat(const std::string& owner) { ownership_.beat(owner, Clock::now()); }
  void release(const std::string& owner);
  void stop();
  /// Returns the equivalent command.
  std::string move(const MotionRequest& request);

  /// Commissions an axis as the command does; the page's start is the consent to all motions within the box. Every
  /// motion needs the page's command: without it, or with the thread's cancellation, the axis slows down, and the run
  /// ends. Meanwhile other motions and changes of parameters are refused.
  nlohmann::json commission(const Request& request, const std::function<void(double, const std::string&)>& tell);
  /// Throws if this page does not command the axes.
  void require_command(const std::string& owner) const { ownership_.require(owner, Clock::now()); }
  const std::string& device() const { return device_.device; }

  void choose(const std::vector<std::string>& names);
  std::string arm(const TriggerWish& wish);
  void disarm() { watch_.disarm(); }
  /// Writes the rows as records, one for each axis; returns their names.
  std::vector<std::string> save(const RowsRequest& range) const;

  nlohmann::json parameters() const;
  /// The assignments of a file of parameters: { NAME: value as text }.
  nlohmann::json staged(const ParameterText& file) const;
  std::string set(const ParametersRequest& request);
  /// Takes the latest change of this session back.
  void undo(const std::string& owner);
  void keep(const std::string& owner);  ///< as `axistool save`

 private:
  using Clock = std::chrono::steady_clock;

  std::string command(const std::string& words) const;
  /// Throws if this page does not command the axes, or if a commissioning moves them.
  void require_free(const std::string& owner) const;

  const Folder& folder_;
  const LiveDevice device_;
  PageOwnership ownership_;
  BoardWatch watch_;
  std::atomic<bool> is_commissioning_ = false;
  mutable std::mutex mutex_;                                        ///< for `before_`
  std::vector<std::vector<std::pair<std::size_t, float>>> before_;  ///< values before each change, latest last
  BoardCommand command_;                                            ///< last: its thread asks for the owner
};

}  // namespace host::workbench
