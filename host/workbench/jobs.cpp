#include "host/workbench/jobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

#include "host/atomic_file.hpp"
#include "host/cancellation.hpp"
#include "host/evidence/log_faults.hpp"
#include "host/exit_codes.hpp"
#include "host/read_file.hpp"
#include "host/workbench/actions.hpp"

namespace host::workbench {

namespace {

constexpr std::size_t kMostWaiting = 50;
constexpr int kMostJobs = 100'000;

std::string state_name(int id) { return fmt::format("{:04}.job.json", id); }

/// Name of the new model: cogging added to x.toml gives x+cogging.toml.
std::string model_stem(const Request& request) {
  const std::string stem = std::filesystem::path(request.models.front()).replace_extension().string();
  if (request.task == Task::add) return fmt::format("{}+{}", stem, request.kind);
  return stem + (request.task == Task::identify ? "-identified"
                 : request.task == Task::adjust ? "-adjusted"
                                                : "-improved");
}

bool is_open(const nlohmann::json& state) { return state["state"] == "queued" || state["state"] == "running"; }

std::int64_t now_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// The state of a job, written by this or an earlier session; null if the file is not valid.
nlohmann::json read_state(const std::string& path) {
  try {
    nlohmann::json state = nlohmann::json::parse(read_file(path), nullptr, false);
    if (!state.is_object()) return nullptr;
    const bool is_state = state.value("format", "") == "axis-job/1" && state.contains("request") &&
                          state.value("id", 0) > 0 && state.value("id", 0) < kMostJobs &&
                          !state.value("state", "").empty() && !state.value("command", "").empty();
    for (const char* text : {"model", "report", "message"}) state[text] = state.value(text, "");
    return is_state ? state : nullptr;
  } catch (const Failure&) {
    return nullptr;
  } catch (const nlohmann::json::exception&) {
    return nullptr;
  }
}

}  // namespace

Jobs::Jobs(const Folder& folder, Commission commission) : folder_(folder), commission_(std::move(commission)) {
  load();
  searcher_ = std::jthread([this](const std::stop_token& stop) { work(stop, Lane::search); });
  fitter_ = std::jthread([this](const std::stop_token& stop) { work(stop, Lane::fit); });
  comparer_ = std::jthread([this](const std::stop_token& stop) { work(stop, Lane::compare); });
  if (commission_) commissioner_ = std::jthread([this](const std::stop_token& stop) { work(stop, Lane::commission); });
}

Jobs::Lane Jobs::lane_of(Task task) {
  if (task == Task::commission) return Lane::commission;
  if (task == Task::compare) return Lane::compare;
  return task == Task::diagnose || task == Task::improve ? Lane::search : Lane::fit;
}

Jobs::~Jobs() {
  searcher_.request_stop();
  fitter_.request_stop();
  comparer_.request_stop();
  commissioner_.request_stop();
  const std::lock_guard lock(mutex_);
  for (const auto& item : jobs_) item.second->is_cancelled = true;
}

void Jobs::load() {
  const std::filesystem::path own = folder_.root() / kOwnFolder;
  if (!std::filesystem::is_directory(std::filesystem::symlink_status(own))) return;
  for (const auto& entry : std::filesystem::directory_iterator(own)) {
    if (!entry.path().string().ends_with(".job.json") || !entry.is_regular_file() || entry.is_symlink()) continue;
    nlohmann::json state = read_state(entry.path().string());
    if (state.is_null()) continue;
    auto job = std::make_unique<Job>();
    try {
      job->request = parse_request(state["request"].dump());
    } catch (const Failure&) {
      continue;
    }
    const int id = state["id"];
    if (is_open(state)) state["state"] = "interrupted";
    job->state = std::move(state);
    jobs_[id] = std::move(job);
  }
}

/// A new folder for a commissioning that has none, and checks one that has.
void Jobs::give_folder(Request& request) const {
  if (!commission_) throw Failure(ExitCode::no_such_device, "axistool serve was started without --device");
  if (std::ranges::any_of(
          jobs_, [](const auto& item) { return item.second->request.commission && is_open(item.second->state); }))
    throw Failure(ExitCode::refused, "another commissioning has not ended: cancel it first");
  std::string& folder = request.commission->folder;
  if (folder.empty())
    folder = folder_.free_name(request.commission->axis, "");
  else
    folder_.existing(folder + "/commission.json");
}

int Jobs::submit(const Request& wanted) {
  const std::lock_guard lock(mutex_);
  Request request = wanted;
  if (request.commission) give_folder(request);
  const int id = jobs_.empty() ? 1 : jobs_.rbegin()->first + 1;
  if (queue_.size() >= kMostWaiting || id >= kMostJobs)
    throw Failure(ExitCode::refused, fmt::format("{} jobs are already waiting", queue_.size()));
  auto job = std::make_unique<Job>();
  job->request = request;
  const std::string stem = fmt::format("{:04}-{}", id, task_name(request.task));
  job->outputs.json = folder_.own_file(stem + ".json");
  const Lane lane = lane_of(request.task);
  if (lane == Lane::search || lane == Lane::compare) job->outputs.report = folder_.own_file(stem + ".html");
  if (request.task == Task::improve || lane == Lane::fit)
    job->outputs.model = folder_.free_name(model_stem(request), ".toml");
  for (const auto& item : jobs_)  // a waiting job has no file yet
    if (!job->outputs.model.empty() && item.second->outputs.model == job->outputs.model)
      job->outputs.model = folder_.free_name(fmt::format("{}-{}", model_stem(request), id), ".toml");
  job->state = {{"format", "axis-job/1"},       {"id", id},
                {"request", to_json(request)},  {"command", command_line(request, job->outputs)},
                {"asked_s", now_s()},           {"model", job->outputs.model},
                {"report", job->outputs.report}};
  keep(*job, "queued");
  jobs_[id] = std::move(job);
  queue_.push_back(id);
  changed_.notify_all();
  return id;
}

void Jobs::keep(Job& job, const std::string& state, const std::string& message) {
  job.state["state"] = state;
  job.state["message"] = message;
  write_file_atomically(folder_.own_file(state_name(job.state["id"])), job.state.dump(2) + "\n");
}

void Jobs::work(const std::stop_token& stop, Lane lane) {
  const auto next = [&] {
    return std::ranges::find_if(queue_, [&](int id) { return lane_of(jobs_.at(id)->request.task) == lane; });
  };
  while (true) {
    Job* job = nullptr;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [&] { return next() != queue_.end(); }) || stop.stop_requested()) return;
      job = jobs_.at(*next()).get();
      queue_.erase(next());
      if (job->is_cancelled) continue;
    }
    run(*job, stop);
  }
}

nlohmann::json Jobs::done(Job& job) {
  const ShareDone progress = [&job](double share) { job.share = share; };
  if (job.request.task == Task::compare) {
    Comparison compared = compare_all(folder_, job.request, progress);
    if (!compared.report.empty()) write_file_atomically(job.outputs.report, compared.report);
    const std::lock_guard lock(mutex_);
    if (compared.report.empty()) job.state["report"] = "";
    job.state["traces"] = std::move(compared.traces);
    job.state["text"] = std::move(compared.text);
    return std::move(compared.document);
  }
  if (!job.request.commission) return carry_out(folder_, job.request, job.outputs, progress);
  return commission_(job.request, [this, &job](double share, const std::string& what) {
    job.share = share;
    const std::lock_guard lock(mutex_);
    keep(job, "running", what);
  });
}

void Jobs::run(Job& job, const std::stop_token& stop) {
  std::string state = "done", message;
  nlohmann::json log;
  try {
    {
      const std::lock_guard lock(mutex_);
      keep(job, "running");
    }
    const CancelledBy scope(&job.is_cancelled);
    const nlohmann::json document = done(job);
    write_file_atomically(job.outputs.json, document.dump(2) + "\n");
    const std::lock_guard lock(mutex_);
    if (job.request.commission && document["page"].is_string()) job.state["report"] = document["page"];
  } catch (const Cancelled&) {
    state = stop.stop_requested() ? "interrupted" : "cancelled";
  } catch (const FaultyLog& refused) {
    state = "failed";
    message = refused.what();
    log = log_faults_json(refused.faults);
  } catch (const std::exception& failure) {
    state = job.is_cancelled ? "cancelled" : "failed";
    message = failure.what();
  }
  const std::lock_guard lock(mutex_);
  if (job.request.commission) job.state["next"] = next_step(job.request.commission->folder);
  if (!log.is_null()) job.state["log"] = log;
  try {
    keep(job, state, message);
  } catch (const std::exception& failure) {  // for example a full disk; the page shows the state anyway
    job.state["message"] = failure.what();
  }
}

nlohmann::json Jobs::told(const Job& job) {
  nlohmann::json state = job.state;
  state["share"] = state["state"] == "done" ? 1.0 : job.share.load();
  return state;
}

nlohmann::json Jobs::list() const {
  const std::lock_guard lock(mutex_);
  nlohmann::json all = nlohmann::json::array();
  for (auto item = jobs_.rbegin(); item != jobs_.rend(); ++item) all.push_back(told(*item->second));
  return {{"format", "axis-jobs/1"}, {"jobs", std::move(all)}};
}

std::optional<nlohmann::json> Jobs::state(int id) const {
  nlohmann::json state;
  {
    const std::lock_guard lock(mutex_);
    const auto found = jobs_.find(id);
    if (found == jobs_.end()) return std::nullopt;
    state = told(*found->second);
    if (state["state"] != "done") return state;
    const std::string name = fmt::format("{:04}-{}.json", id, task_name(found->second->request.task));
    try {
      state["document"] = nlohmann::json::parse(read_file(folder_.existing(folder_.own_file(name))), nullptr, false);
    } catch (const Failure& failure) {
      state["message"] = failure.what();
    }
  }
  return state;
}

std::vector<nlohmann::json> Jobs::steps_to(std::string model) const {
  std::vector<int> ids;
  {
    const std::lock_guard lock(mutex_);
    // The job of a step is older than the job that continues from it.
    for (auto item = jobs_.rbegin(); item != jobs_.rend(); ++item) {
      const Job& job = *item->second;
      if (job.state["state"] != "done" || job.state["model"] != model) continue;
      ids.push_back(item->first);
      model = job.request.models.front();
    }
  }
  std::vector<nlohmann::json> steps;
  for (auto id = ids.rbegin(); id != ids.rend(); ++id) steps.push_back(*state(*id));
  return steps;
}

bool Jobs::cancel(int id) {
  const std::lock_guard lock(mutex_);
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return false;
  found->second->is_cancelled = true;
  if (found->second->state["state"] == "queued") keep(*found->second, "cancelled");
  return true;
}

}  // namespace host::workbench
