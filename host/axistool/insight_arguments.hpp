// What diagnose, add and improve have in common: a model, records to train on, records to validate on.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "host/axistool/json_output.hpp"
#include "host/axistool/load_records.hpp"
#include "host/diagnose/diagnosis.hpp"
#include "host/model/model_file.hpp"
#include "host/report/progress.hpp"

namespace axistool {

struct InsightArguments {
  std::string model, output, json, report;
  std::vector<std::string> train, validate;

  void add_to(CLI::App& command) {
    command.add_option("model", model, "model file (axis-model/1)")->required();
    command.add_option("--train", train, "records that the fit may see")->required();
    command.add_option("--validate", validate,
                       "records that judge; without them blocks of the training data are kept back");
    add_json_option(command, json);
  }
};

/// The records of a command, read and checked; pointers into it stay valid.
struct InsightRecords {
  sim::DriveDescription model;
  std::vector<host::Record> train, validate;

  explicit InsightRecords(const InsightArguments& arguments)
      : model(host::read_model(arguments.model)),
        train(load_records(arguments.train, model.data)),
        validate(load_records(arguments.validate, model.data)) {}

  static std::vector<const host::Record*> pointers(const std::vector<host::Record>& records) {
    std::vector<const host::Record*> result;
    for (const host::Record& record : records) result.push_back(&record);
    return result;
  }
};

/// Progress of a search on the terminal, in thousandths.
class SearchProgress {
 public:
  explicit SearchProgress(const std::string& what) : line_(what, kSteps) {}

  host::ShareDone callback() {
    return [this](double share) {
      const auto reached = static_cast<std::size_t>(share * kSteps);
      const std::lock_guard guard(lock_);
      if (reached > shown_) {
        line_.advance(reached - shown_, "");
        shown_ = reached;
      }
    };
  }

 private:
  static constexpr std::size_t kSteps = 1000;
  host::Progress line_;
  std::mutex lock_;
  std::size_t shown_ = 0;
};

}  // namespace axistool
