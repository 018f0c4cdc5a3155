#include "host/workbench/loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "host/atomic_file.hpp"
#include "host/exit_codes.hpp"
#include "host/hil/designed_loop.hpp"
#include "host/identify/plausibility.hpp"
#include "host/known_by_current.hpp"
#include "host/model/model_file.hpp"
#include "host/parameters/design_file.hpp"
#include "host/report/text_format.hpp"
#include "host/workbench/request_fields.hpp"

namespace host::workbench {

namespace {

/// Positive numbers of a list, `fewest` to `most`; empty if there is no such field.
std::vector<double> positive_of(const nlohmann::json& object, const std::string& field, std::size_t fewest,
                                std::size_t most) {
  std::vector<double> numbers;
  const auto found = object.find(field);
  if (found == object.end()) return numbers;
  if (!found->is_array() || found->size() < fewest || found->size() > most) refuse(field, "expected a list of numbers");
  for (const nlohmann::json& one : *found) {
    numbers.push_back(number_of(one, field));
    if (!(numbers.back() > 0.0)) refuse(field, "expected numbers above 0");
  }
  return numbers;
}

/// A number above 0; `usual` if there is no such field.
double positive_or(const nlohmann::json& object, const std::string& field, double usual) {
  const auto found = object.find(field);
  if (found == object.end()) return usual;
  const double value = number_of(*found, field);
  if (!(value > 0.0)) refuse(field, "expected a number above 0");
  return value;
}

std::string response_name(const std::string& name, const std::string& field) {
  return name == kModelled ? name : file_of(name, field);
}

}  // namespace

LoopRequest parse_loop(std::string_view text) {
  const nlohmann::json document = object_of(text);
  require_known(document, {"model", "response", "fc", "zeta", "notch", "low_pass", "margin", "write"});
  LoopRequest request;
  request.model = file_of(text_of(document, "model"), "model");
  request.response = list_of(document, "response", response_name);
  request.options.bandwidth_Hz = positive_or(document, "fc", request.options.bandwidth_Hz);
  request.options.damping = positive_or(document, "zeta", request.options.damping);
  request.aim.seek_notch = document.contains("notch") && document["notch"] == "auto";
  if (!request.aim.seek_notch)
    if (const std::vector<double> notch = positive_of(document, "notch", 3, 3); !notch.empty())
      request.aim.filters.notch = Notch{notch[0], notch[1], notch[2]};
  if (const std::vector<double> low_pass = positive_of(document, "low_pass", 2, 2); !low_pass.empty())
    request.aim.filters.low_pass = LowPass{low_pass[0], low_pass[1]};
  if (document.contains("margin")) {
    request.aim.modulus = positive_or(document, "margin", 0.0);
    if (*request.aim.modulus >= 1.0) refuse("margin", "expected a modulus margin below 1");
  }
  request.writes = flag_of(document, "write");
  if (request.response.empty()) refuse("response", "expected \"model\", or files of a measured response");
  return request;
}

std::string loop_command(const LoopRequest& request, const std::string& output) {
  std::string line = fmt::format("axistool design {} --fc {:g} --zeta {:g} --response", shell_word(request.model),
                                 request.options.bandwidth_Hz, request.options.damping);
  for (const std::string& name : request.response) line += " " + shell_word(name);
  if (request.aim.modulus) line += fmt::format(" --margin {:g}", *request.aim.modulus);
  const ControlFilterChoice& filters = request.aim.filters;
  if (request.aim.seek_notch) line += " --notch auto";
  if (filters.notch)
    line += fmt::format(" --notch {:g},{:g},{:g}", filters.notch->f_Hz, filters.notch->damping, filters.notch->depth);
  if (filters.low_pass) line += fmt::format(" --low-pass {:g},{:g}", filters.low_pass->f_Hz, filters.low_pass->damping);
  return output.empty() ? line : line + " -o " + shell_word(output);
}

nlohmann::json design_of(const Folder& folder, const LoopRequest& request) {
  const sim::DriveDescription model = read_model(folder.existing(request.model), Bounds::examined_later);
  require_volts(model.data, model.name, "a controller");
  require_plausible(model, {});
  for (const std::string& name : request.response)
    if (name != kModelled) folder.existing(name);
  const DesignedLoop designed =
      designed_loop(model, request.options, request.aim, {}, response_of(request.response, model));
  const std::string parameters = design_toml(model, designed.design, designed.filters, designed.limits.written);
  std::string written;
  if (request.writes) {
    written = folder.free_name(std::filesystem::path(request.model).replace_extension().string() + "-params", ".toml");
    write_file_atomically(written, parameters);
  }
  return {{"document", designed_loop_json(designed)},
          {"report", designed_loop_report(model, designed, request.options).html()},
          {"parameters", parameters},
          {"written", written},
          {"command", loop_command(request, written)}};
}

}  // namespace host::workbench
