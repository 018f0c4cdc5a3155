#include "host/commission/folder.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "host/atomic_file.hpp"
#include "host/exit_codes.hpp"
#include "host/nearest_name.hpp"
#include "host/output_target.hpp"
#include "host/read_file.hpp"

namespace host {

namespace {

constexpr const char* kState = "commission.json";

nlohmann::json parse(const std::string& path) {
  nlohmann::json content = nlohmann::json::parse(read_file(path), nullptr, false);
  if (content.is_discarded()) throw Failure(ExitCode::bad_input, path + ": not valid JSON; was it edited?");
  return content;
}

}  // namespace

std::size_t commission_step(std::string_view name) {
  std::string known;
  std::vector<std::string_view> names;
  for (std::size_t step = 0; step < kCommissionSteps.size(); ++step) {
    if (kCommissionSteps[step].name == name) return step;
    names.push_back(kCommissionSteps[step].name);
    known += (step == 0 ? "" : ", ") + std::string(kCommissionSteps[step].name);
  }
  throw Failure(ExitCode::usage,
                fmt::format("there is no step {}{}; the steps are {}", name, did_you_mean(name, names), known));
}

CommissionFolder::CommissionFolder(std::string folder) : folder_(std::move(folder)) {
  require_output_folder(folder_);
  std::error_code fault;
  std::filesystem::create_directories(folder_, fault);
  if (fault)
    throw Failure(ExitCode::permission, fmt::format("{}: cannot make this folder: {}", folder_, fault.message()));
  if (has(kState)) {
    document_ = parse(path(kState));
    if (!document_.is_object() || document_.value("format", "") != "axis-commission/1" ||
        !document_.contains("steps") || document_["steps"].size() != kCommissionSteps.size())
      throw Failure(ExitCode::bad_input, path(kState) + ": not a commissioning of this axistool; give another -o");
    return;
  }
  document_ = {{"format", "axis-commission/1"},
               {"steps", nlohmann::json::array()},
               {"verdict", nullptr},
               {"following_error_um", nullptr},
               {"kept", nullptr},
               {"page", nullptr}};
  for (const CommissionStepText& step : kCommissionSteps)
    document_["steps"].push_back({{"name", step.name}, {"done", false}, {"files", nlohmann::json::array()}});
}

std::string CommissionFolder::path(std::string_view file) const {
  return (std::filesystem::path(folder_) / file).string();
}

bool CommissionFolder::has(std::string_view file) const {
  std::error_code fault;
  return std::filesystem::is_regular_file(path(file), fault);
}

std::string CommissionFolder::require(std::string_view file, std::string_view step) const {
  if (!has(file))
    throw Failure(ExitCode::usage,
                  fmt::format("{} is missing: continue with --from {}, which makes it", path(file), step));
  return path(file);
}

bool CommissionFolder::is_done(std::size_t step) const { return document_["steps"].at(step).value("done", false); }

std::optional<std::size_t> CommissionFolder::first_undone() const {
  for (std::size_t step = 0; step < kCommissionSteps.size(); ++step)
    if (!is_done(step)) return step;
  return std::nullopt;
}

void CommissionFolder::begin_at(std::size_t step) {
  for (; step < kCommissionSteps.size(); ++step)
    document_["steps"][step] = {
        {"name", kCommissionSteps[step].name}, {"done", false}, {"files", nlohmann::json::array()}};
  document_.erase("stopped_because");
  document_["page"] = nullptr;  // until it is written; a page may be left from another run
  keep();
}

void CommissionFolder::finish(std::size_t step, const std::vector<std::string>& files, const std::string& said) {
  document_["steps"][step]["done"] = true;
  document_["steps"][step]["files"] = files;
  document_["steps"][step]["said"] = said;
  keep();
}

void CommissionFolder::put(const std::string& key, const nlohmann::json& value) {
  document_[key] = value;
  keep();
}

nlohmann::json CommissionFolder::read_json(std::string_view file) const { return parse(path(file)); }

void CommissionFolder::write_json(std::string_view file, const nlohmann::json& content) const {
  write_file_atomically(path(file), content.dump(2) + "\n");
}

void CommissionFolder::keep() const { write_json(kState, document_); }

}  // namespace host
