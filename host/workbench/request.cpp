#include "host/workbench/request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <utility>

#include "host/exit_codes.hpp"
#include "host/report/text_format.hpp"

namespace host::workbench {

namespace {

constexpr std::array kTasks{std::pair{"compare", Task::compare},      std::pair{"identify", Task::identify},
                            std::pair{"diagnose", Task::diagnose},    std::pair{"add", Task::add},
                            std::pair{"adjust", Task::adjust},        std::pair{"improve", Task::improve},
                            std::pair{"commission", Task::commission}};

/// Accepts a lower-case word, such as the name of an effect or of a fault of the log.
std::string word_of(const std::string& text, const std::string& field) {
  constexpr std::size_t kLongestWord = 60;
  const bool is_word = text.size() <= kLongestWord &&
                       std::ranges::all_of(text, [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; });
  if (!is_word) refuse(field, "expected a word of small letters and _");
  return text;
}

/// Accepts an effect, or several joined by +.
std::string kinds_of(const std::string& text) {
  std::string words = text;
  std::ranges::replace(words, '+', '_');
  word_of(words, "kind");
  return text;
}

/// Accepts a value such as "cogging.cosine_72=0.2".
std::string value_of(const std::string& text, const std::string& field) {
  constexpr std::size_t kLongestValue = 120;
  const std::size_t equals = text.find('=');
  const bool is_value = text.size() <= kLongestValue && equals != std::string::npos && equals > 0 &&
                        std::ranges::all_of(text, [](char c) {
                          return std::isalnum(static_cast<unsigned char>(c)) ||
                                 std::string_view("_.=+-").find(c) != std::string_view::npos;
                        });
  if (!is_value || text.front() == '-') refuse(field, "expected a list of NAME=VALUE");
  return text;
}

std::optional<TimeSpan> stretch_of(const nlohmann::json& object) {
  const auto found = object.find("stretch");
  if (found == object.end()) return std::nullopt;
  if (!found->is_array() || found->size() != 2) refuse("stretch", "expected [FROM, TO] in seconds");
  const TimeSpan stretch{number_of((*found)[0], "stretch"), number_of((*found)[1], "stretch")};
  if (!(stretch.from_s < stretch.to_s)) refuse("stretch", "it ends after it begins");
  return stretch;
}

Focus focus_of(const nlohmann::json& object) {
  Focus focus;
  if (object.contains("traces")) focus.record = file_of(text_of(object, "traces"), "traces");
  focus.stretch = stretch_of(object);
  if (object.contains("period_mm")) focus.period_mm = number_of(object["period_mm"], "period_mm");
  if (const std::vector<std::string> map = list_of(object, "map", word_of); !map.empty()) {
    const auto is_known = [](const std::string& name) {
      return std::ranges::find(kMapCoordinates, name) != kMapCoordinates.end();
    };
    if (map.size() != 2 || !std::ranges::all_of(map, is_known)) refuse("map", "expected two coordinates");
    focus.map = {map.front(), map.back()};
  }
  if (const std::vector<std::string> plot = list_of(object, "plot", word_of); !plot.empty()) {
    const auto is_known = [](const std::string& name) {
      return std::ranges::find(kPlotCoordinates, name) != kPlotCoordinates.end();
    };
    if (plot.size() != 2 || !is_known(plot[0]) || !(is_known(plot[1]) || plot[1] == kPlottedError))
      refuse("plot", "expected two coordinates");
    focus.plot = {plot.front(), plot.back()};
  }
  if (focus.period_mm && !(*focus.period_mm > 0.0)) refuse("period_mm", "expected a length above 0");
  return focus;
}

std::string options_of(const char* option, const std::vector<std::string>& values, bool one_by_one = false) {
  std::string text = values.empty() || one_by_one ? "" : fmt::format(" {}", option);
  for (const std::string& value : values)
    text += fmt::format("{} {}", one_by_one ? fmt::format(" {}", option) : "", shell_word(value));
  return text;
}

std::string output_option(const char* option, const std::string& name) {
  return name.empty() ? "" : fmt::format(" {} {}", option, shell_word(name));
}

}  // namespace

std::string_view task_name(Task task) {
  return std::ranges::find(kTasks, task, &std::pair<const char*, Task>::second)->first;
}

Request parse_request(std::string_view text) {
  const nlohmann::json document = object_of(text);
  const std::string name = text_of(document, "do");
  const auto* const task = std::ranges::find(kTasks, name, &std::pair<const char*, Task>::first);
  if (task == kTasks.end()) refuse("do", "expected compare, identify, diagnose, add, adjust, improve or commission");
  Request request;
  request.task = task->second;
  if (request.task == Task::commission) {
    request.commission = parse_commission(document);
    request.models = {file_of(text_of(document, "model"), "model")};
    return request;
  }
  if (request.task == Task::compare) {
    require_known(document,
                  {"do", "models", "records", "accept", "traces", "stretch", "period_mm", "map", "plot", "like"});
    request.models = list_of(document, "models", file_of);
    request.train = list_of(document, "records", file_of);
    request.focus = focus_of(document);
    request.like = word_of(text_of(document, "like"), "like");
    if (!request.like.empty() && std::ranges::find(kPlotCoordinates, request.like) == kPlotCoordinates.end())
      refuse("like", "expected a coordinate");
  } else {
    require_known(document,
                  {"do", "model", "train", "validate", "accept", "absent", "kind", "over", "values", "quick"});
    request.models = {file_of(text_of(document, "model"), "model")};
    request.train = list_of(document, "train", file_of);
    request.validate = list_of(document, "validate", file_of);
    request.absent = list_of(document, "absent", word_of);
    request.kind = kinds_of(text_of(document, "kind"));
    request.over = word_of(text_of(document, "over"), "over");
    request.values = list_of(document, "values", value_of);
    request.quick = flag_of(document, "quick");
  }
  request.accepted = list_of(document, "accept", word_of);
  if (request.models.empty()) refuse("models", "expected at least one model");
  if (request.train.empty())
    refuse(request.task == Task::compare ? "records" : "train", "expected at least one record");
  if ((request.task == Task::add) == request.kind.empty()) refuse("kind", "add needs an effect, and it alone");
  if (request.task != Task::add && !request.over.empty()) refuse("over", "belongs to add");
  if ((request.task == Task::adjust) == request.values.empty()) refuse("values", "adjust needs some, and it alone");
  if (request.quick && request.task != Task::diagnose) refuse("quick", "belongs to diagnose");
  const bool searches = request.task == Task::diagnose || request.task == Task::improve;
  if (!searches && !request.absent.empty()) refuse("absent", "belongs to diagnose and improve");
  if (request.task == Task::identify && !request.validate.empty()) refuse("validate", "identify takes none");
  return request;
}

CutRequest parse_cut(std::string_view text) {
  const nlohmann::json document = object_of(text);
  require_known(document, {"record", "stretch", "keep"});
  const std::optional<TimeSpan> stretch = stretch_of(document);
  if (!stretch) refuse("stretch", "expected [FROM, TO] in seconds");
  return {file_of(text_of(document, "record"), "record"), *stretch, flag_of(document, "keep")};
}

OpenRequest parse_open(std::string_view text) {
  const nlohmann::json document = object_of(text);
  require_known(document, {"logs", "yes", "map"});
  const auto own = [](const std::string& mapping, const std::string&) { return mapping; };
  OpenRequest request{list_of(document, "logs", file_of), flag_of(document, "yes"), list_of(document, "map", own)};
  if (request.logs.empty()) refuse("logs", "expected at least one log");
  return request;
}

nlohmann::json parse_choice(std::string_view text) {
  const nlohmann::json document = object_of(text);
  require_known(document, {"model", "beside", "roles"});
  nlohmann::json choice = {{"model", nullptr}, {"beside", list_of(document, "beside", file_of)}};
  if (const std::string model = text_of(document, "model"); !model.empty()) choice["model"] = file_of(model, "model");
  choice["roles"] = nlohmann::json::object();
  const auto roles = document.find("roles");
  if (roles == document.end()) return choice;
  if (!roles->is_object() || roles->size() > kMostNames) refuse("roles", "expected an object of names and roles");
  for (const auto& item : roles->items()) {
    const nlohmann::json& role = item.value();
    if (role != "train" && role != "judge" && role != "off") refuse("roles", "expected train, judge or off");
    choice["roles"][file_of(item.key(), "roles")] = role;
  }
  return choice;
}

nlohmann::json to_json(const Request& request) {
  nlohmann::json document = {{"do", task_name(request.task)}, {"accept", request.accepted}};
  if (request.task == Task::compare) {
    document["models"] = request.models;
    document["records"] = request.train;
    if (!request.focus.record.empty()) document["traces"] = request.focus.record;
    if (const auto& stretch = request.focus.stretch) document["stretch"] = {stretch->from_s, stretch->to_s};
    if (request.focus.map) document["map"] = {request.focus.map->first, request.focus.map->second};
    if (request.focus.plot) document["plot"] = {request.focus.plot->first, request.focus.plot->second};
    if (request.focus.period_mm) document["period_mm"] = *request.focus.period_mm;
    if (!request.like.empty()) document["like"] = request.like;
    return document;
  }
  document["model"] = request.models.front();
  if (request.commission) {
    put(*request.commission, document);
    return document;
  }
  document["train"] = request.train;
  document["validate"] = request.validate;
  if (!request.absent.empty()) document["absent"] = request.absent;
  if (!request.kind.empty()) document["kind"] = request.kind;
  if (!request.over.empty()) document["over"] = request.over;
  if (!request.values.empty()) document["values"] = request.values;
  if (request.quick) document["quick"] = true;
  return document;
}

std::string command_line(const Request& request, const Outputs& outputs) {
  if (request.commission)
    return command_line(*request.commission, request.models.front()) + output_option("--json", outputs.json);
  std::string line = fmt::format("axistool {}", task_name(request.task));
  if (request.task != Task::identify)
    for (const std::string& model : request.models) line += fmt::format(" {}", shell_word(model));
  if (!request.kind.empty()) line += fmt::format(" {}", shell_word(request.kind));
  for (const std::string& value : request.values) line += fmt::format(" {}", shell_word(value));
  if (request.quick) line += " --quick";
  if (request.task != Task::compare && request.task != Task::identify) line += " --train";
  for (const std::string& record : request.train) line += fmt::format(" {}", shell_word(record));
  if (request.task == Task::identify) line += fmt::format(" --drive {}", shell_word(request.models.front()));
  line += options_of("--validate", request.validate) + options_of("--absent", request.absent);
  line += options_of("--accept", request.accepted, true);
  line += output_option("--traces", request.focus.record);
  if (const auto& stretch = request.focus.stretch)
    line += fmt::format(" --stretch {} {}", stretch->from_s, stretch->to_s);
  if (request.focus.map) line += fmt::format(" --map {} {}", request.focus.map->first, request.focus.map->second);
  if (request.focus.plot) line += fmt::format(" --plot {},{}", request.focus.plot->first, request.focus.plot->second);
  if (request.focus.period_mm) line += fmt::format(" --period {}", *request.focus.period_mm);
  line += output_option("--like", request.like) + output_option("--over", request.over) +
          output_option("-o", outputs.model);
  return line + output_option("--json", outputs.json) + output_option("--report", outputs.report);
}

}  // namespace host::workbench
