// `axis-diagnosis/1` and `axis-improvement/1`.
#pragma once

#include <nlohmann/json.hpp>

#include "host/diagnose/improvement.hpp"

namespace host {

nlohmann::json to_json(const Diagnosis& diagnosis);
/// `model_path`: file of the improved model; may be empty.
nlohmann::json to_json(const Improvement& improvement, const std::string& model_path);

}  // namespace host
