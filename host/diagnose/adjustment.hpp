// A model with values set by hand, and the errors before and after: `axis-adjustment/1`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/diagnose/figure_rows.hpp"

namespace host {

struct Adjustment {
  sim::DriveDescription model;
  ErrorOnSets given, after;
};

/// Nothing is fitted. Throws as figure_rows() does.
Adjustment adjust(const sim::DriveDescription& model, const sim::DriveDescription& adjusted,
                  const Measurements& measured);

/// `values`: what was set, each "NAME=VALUE"; `model_path`: path of the adjusted model.
nlohmann::json to_json(const Adjustment& adjustment, const std::vector<std::string>& values,
                       const Measurements& measured, const std::string& model_path);

}  // namespace host
