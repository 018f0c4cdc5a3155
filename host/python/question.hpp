// Input of diagnose, improve, add and plan: a model, and records for training and validation.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

#include "host/evidence/measurement_gate.hpp"
#include "host/model/effect_forms.hpp"
#include "host/model/known_parameters.hpp"
#include "host/python/sources.hpp"

namespace axistool_python {

using Names = std::vector<std::string>;
/// The document of a result, and the text of its file: a model, parameters, or a run.
using Answer = std::pair<std::string, std::string>;

struct Question {
  ModelSource model;
  std::vector<RecordSource> train, validate;
  Names held, believed, absent;

  Question(const pybind11::object& model_given, const pybind11::sequence& train_given,
           const pybind11::sequence& validate_given, Names hold, Names prior, Names without)
      : model(model_given),
        train(record_sources(train_given, "training record")),
        validate(record_sources(validate_given, "validation record")),
        held(std::move(hold)),
        believed(std::move(prior)),
        absent(std::move(without)) {}

  sim::DriveDescription drive() const {
    for (const std::string& kind : absent) host::known_effect(kind);
    return host::with_knowledge(model.read(), held, believed);
  }
  host::Measurements measurements(const sim::DriveDescription& drive) const {
    return host::MeasurementGate(drive).admit(read_all(train), read_all(validate));
  }
};

}  // namespace axistool_python
