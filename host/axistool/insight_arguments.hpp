// Common options of diagnose, add and improve: a model, training records, validation records.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "host/axistool/gate_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/diagnose/diagnosis.hpp"
#include "host/model/known_parameters.hpp"
#include "host/model/model_file.hpp"
#include "host/report/progress.hpp"

namespace axistool {

struct InsightArguments {
  std::string model, output, json, report;
  std::vector<std::string> train, validate, accepted, held, believed, absent;

  void add_to(CLI::App& command) {
    add_input(command, "model", model, "model file (axis-model/1)")->required();
    add_input(command, "--train", train, "training records")->required();
    add_input(command, "--validate", validate,
              "validation records; default: blocks of the training data are held back");
    command.add_option("--hold", held, "parameters to keep at the model's values, e.g. J_kg_m2")->expected(1, -1);
    command.add_option("--prior", believed, "standard deviations of the model's values, e.g. J_kg_m2=1e-4")
        ->expected(1, -1);
    command.add_option("--absent", absent, "effects that this machine certainly does not have, e.g. backlash")
        ->expected(1, -1);
    add_accept_option(command, accepted);
    add_json_option(command, json);
  }
};

/// A model and its records, accepted by the gate.
struct InsightRecords {
  sim::DriveDescription model;
  host::Measurements measurements;

  explicit InsightRecords(const InsightArguments& arguments)
      : model(host::with_knowledge(host::read_model(arguments.model), arguments.held, arguments.believed)),
        measurements(host::MeasurementGate(model, {arguments.accepted}).read(arguments.train, arguments.validate)) {}
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
