// A published drive case: the engineer's model, the measurements, and the hidden effects.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/diagnose/diagnosis.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/model/model_file.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/read_record.hpp"
#include "tests/host/skip_where_instrumented.hpp"

struct DriveCase {
  sim::DriveDescription model;
  std::vector<host::Record> train, validate;
  std::vector<std::string> effects;              ///< hidden effects
  std::vector<std::vector<std::string>> groups;  ///< effects that these data may be unable to tell apart

  /// `name` is "single/case-06".
  explicit DriveCase(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::path(AXIS_TEST_DATA) / "drive-cases" / name;
    model = host::read_model((folder / "model.toml").string());
    std::vector<std::string> paths;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".csv") paths.push_back(entry.path().string());
    std::ranges::sort(paths);
    for (const std::string& path : paths) {
      host::Record record = host::read_record(path);
      host::adapt_to(record, model.data);
      (path.ends_with("validate.csv") ? validate : train).push_back(std::move(record));
    }
    std::ifstream in(folder / "truth.json");
    const nlohmann::json truth = nlohmann::json::parse(in);
    effects = truth.at("effects").get<std::vector<std::string>>();
    groups = truth.at("groups").get<std::vector<std::vector<std::string>>>();
  }

  /// Refers to the records that the gate accepted, which exist as long as this case.
  host::Diagnosis diagnose() {
    measured.emplace(host::MeasurementGate(model).admit(train, validate));
    return host::diagnose(model, *measured);
  }

 private:
  std::optional<host::Measurements> measured;
};
