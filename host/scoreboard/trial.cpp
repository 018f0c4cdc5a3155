#include "host/scoreboard/trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/exit_codes.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/columns.hpp"
#include "host/record/read_record.hpp"

namespace host {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> training_records(const fs::path& folder) {
  std::vector<std::string> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().starts_with("train-") && entry.path().extension() == ".csv")
      paths.push_back(entry.path().string());
  if (paths.empty()) throw Failure(ExitCode::bad_input, folder.string() + ": no training record; add train-*.csv");
  std::ranges::sort(paths);
  return paths;
}

std::string short_name(const std::string& path) { return fs::path(path).stem().string().substr(6); }  // train-

}  // namespace

std::vector<fs::path> find_cases(const std::string& folder) {
  if (!fs::is_directory(folder))
    throw Failure(ExitCode::bad_input, folder + ": no such folder; give the folder that holds the cases");
  std::vector<fs::path> cases;
  const auto add = [&cases](const fs::path& path) {
    if (fs::exists(path / "truth.json") && fs::exists(path / "model.toml") && fs::exists(path / "validate.csv"))
      cases.push_back(path);
  };
  add(folder);
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_directory()) add(entry.path());
  if (cases.empty())
    throw Failure(ExitCode::bad_input, folder +
                                           ": no case below; a case is a folder with model.toml, train-*.csv, "
                                           "validate.csv and truth.json");
  std::ranges::sort(cases);
  return cases;
}

Truth read_truth(const fs::path& case_folder) {
  const fs::path file = case_folder / "truth.json";
  std::ifstream in(file);
  try {
    const nlohmann::json document = nlohmann::json::parse(in);
    return {document.at("effects").get<std::vector<std::string>>(), document.contains("alien")};
  } catch (const nlohmann::json::exception& error) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: no list \"effects\" of kinds ({})", file.string(), error.what()));
  }
}

Trial whole_case(const fs::path& folder, const std::string& name) {
  Trial trial{name, "whole", folder, {}, {{(folder / "validate.csv").string()}}};
  for (const std::string& path : training_records(folder)) trial.train.push_back({path});
  return trial;
}

std::vector<Trial> pieces_of_case(const fs::path& folder, const std::string& name, const std::vector<double>& lengths_s,
                                  bool pairs) {
  std::vector<Trial> trials;
  const std::vector<std::string> paths = training_records(folder);
  for (std::size_t k = 0; k < paths.size(); ++k) {
    const std::string record = name + " " + short_name(paths[k]);
    trials.push_back({record, "one record", folder, {{paths[k]}}, {}});
    for (std::size_t other = k + 1; pairs && other < paths.size(); ++other)
      trials.push_back(
          {record + "+" + short_name(paths[other]), "two records", folder, {{paths[k]}, {paths[other]}}, {}});
    for (const double length_s : lengths_s)
      trials.push_back({fmt::format("{} {:g} s", record, length_s),
                        fmt::format("{:g} s", length_s),
                        folder,
                        {{paths[k], 0.0, length_s}},
                        {}});
  }
  return trials;
}

Record read_piece(const Piece& piece, const sim::DataSheet& data) {
  Record record = read_record(piece.path);
  adapt_to(record, data);
  check_units(record, data);
  const auto row_at = [&](double time_s) {
    const double row = std::min(static_cast<double>(record.size()), time_s / record.sample_period_s);
    return static_cast<std::ptrdiff_t>(std::lround(row));
  };
  const std::ptrdiff_t begin = row_at(piece.from_s), end = row_at(piece.to_s);
  if (end - begin < 2)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: no samples from {:g} s to {:g} s", piece.path, piece.from_s, piece.to_s));
  for (const auto channel : kChannelsInFileOrder)
    if (std::vector<double>& values = record.*channel; !values.empty())
      values = std::vector<double>(values.begin() + begin, values.begin() + end);
  record.extra.clear();
  return record;
}

}  // namespace host
