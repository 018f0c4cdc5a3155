// Long tasks with progress and cancellation: at a time one search, one fit, one comparison and one commissioning. A
// job's state is in workbench/0007.job.json and its results are beside that file, so that they survive a reload or a
// crash.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "host/workbench/folder.hpp"
#include "host/workbench/request.hpp"

namespace host::workbench {

class Jobs {
 public:
  /// Share of the work that is done, and what is being done.
  using Tell = std::function<void(double, const std::string&)>;
  /// Commissions an axis and returns the command's document. Throws as the command does, and Cancelled.
  using Commission = std::function<nlohmann::json(const Request&, const Tell&)>;

  /// Reads the jobs of earlier sessions. Unfinished ones are "interrupted". `commission`: empty without a board.
  explicit Jobs(const Folder& folder, Commission commission = {});
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;
  /// Cancels the running job and waits for its end.
  ~Jobs();

  /// Throws Failure(refused) if too many jobs wait, or if another commissioning has not ended.
  int submit(const Request& request);

  /// "axis-jobs/1": states without results, latest first.
  nlohmann::json list() const;

  /// "axis-job/1": { "id", "request", "command", "state": "queued"|"running"|"done"|"failed"|"cancelled"|"interrupted",
  /// "share", "message", "model", "report", "next": step at
  /// which a commissioning continues, "traces", "text": as in Comparison, "document": the command's --json }; empty if
  /// there is no such job.
  std::optional<nlohmann::json> state(int id) const;

  /// States, with documents, of the jobs that led to a model, in their order.
  std::vector<nlohmann::json> steps_to(std::string model) const;

  /// Cancels a job that has not ended. False if there is no such job.
  bool cancel(int id);

 private:
  struct Job {
    Request request;
    Outputs outputs;
    nlohmann::json state;
    std::atomic<bool> is_cancelled = false;
    std::atomic<double> share = 0.0;
  };

  /// What one thread does.
  enum class Lane { search, fit, compare, commission };

  static Lane lane_of(Task task);
  void load();
  void give_folder(Request& request) const;
  void work(const std::stop_token& stop, Lane lane);
  nlohmann::json done(Job& job);
  void run(Job& job, const std::stop_token& stop);
  void keep(Job& job, const std::string& state, const std::string& message = "");
  static nlohmann::json told(const Job& job);

  const Folder& folder_;
  const Commission commission_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::map<int, std::unique_ptr<Job>> jobs_;
  std::deque<int> queue_;
  std::jthread searcher_, fitter_, comparer_, commissioner_;  ///< last members, because they use the others
};

}  // namespace host::workbench
