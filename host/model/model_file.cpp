#include "host/model/model_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"
#include "host/known_by_current.hpp"
#include "host/model/data_sheet_fields.hpp"
#include "host/model/effect_forms.hpp"
#include "host/nearest_name.hpp"
#include "host/read_file.hpp"
#include "host/statistics.hpp"
#include "host/toml_text.hpp"
#include "sim/catalogue.hpp"
#include "sim/curve.hpp"
#include "sim/harmonic.hpp"

namespace host {

namespace {

using sim::DriveKind;
using Names = std::vector<std::string_view>;

constexpr std::string_view kModelFormat = "axis-model/1";
constexpr std::string_view kIntervalSuffix = "_ci95";
constexpr std::string_view kHeldSuffix = "_held";
constexpr std::string_view kDeviationSuffix = "_sd";
constexpr std::string_view kGivenSuffix = "_given";  ///< mean of the prior, if a fit has changed the value
constexpr std::string_view kHarmonics = "harmonics";
constexpr std::string_view kForcePerVolt = "force_constant_N_per_V", kForcePerAmpere = "force_constant_N_per_A";

class ModelReader {
 public:
  ModelReader(std::string_view text, std::string_view name, Bounds bounds = Bounds::enforced)
      : name_(name), bounds_(bounds), root_(parse_toml(text, name)) {}

  sim::DriveDescription read(bool effects_required) {
    refuse_unknown(root_, {"format", "name", "drive", "effect"}, "at the top");
    const std::string format = text_at(root_, "format", "the top", true);
    if (format != kModelFormat)
      fail(line_of(*root_.get("format")), "format: '{}' is unknown; this program reads {}", format, kModelFormat);
    model_.name = text_at(root_, "name", "the top", false);
    read_data_sheet();
    read_effects(effects_required);
    return std::move(model_);
  }

 private:
  template <typename... Args>
  [[noreturn]] void fail(std::size_t line, fmt::format_string<Args...> format, Args&&... args) const {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: line {}: {}", name_, line, fmt::format(format, std::forward<Args>(args)...)));
  }

  static std::size_t line_of(const toml::node& node) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(node.source().begin.line));
  }

  void refuse_unknown(const toml::table& table, const Names& known, std::string_view where) const {
    for (const auto& [key, node] : table)
      if (std::ranges::find(known, key.str()) == known.end())
        fail(std::max<std::size_t>(1, key.source().begin.line), "unknown field {} {}{} (known: {})", key.str(), where,
             did_you_mean(key.str(), known), fmt::join(known, ", "));
  }

  std::string text_at(const toml::table& table, std::string_view key, std::string_view where, bool required) const {
    const toml::node* node = table.get(key);
    if (node == nullptr && !required) return {};
    if (node == nullptr) fail(line_of(table), "missing field {} at {}; add {} = \"…\"", key, where, key);
    if (!node->is_string()) fail(line_of(*node), "{}: expected a text in quotes", key);
    return node->as_string()->get();
  }

  double number_of(const toml::node& node, std::string_view key) const {
    if (const auto* integer = node.as_integer()) return static_cast<double>(integer->get());
    const auto* real = node.as_floating_point();
    if (real == nullptr) fail(line_of(node), "{}: expected a number, without quotes", key);
    if (!std::isfinite(real->get())) fail(line_of(node), "{}: expected a finite number", key);
    return real->get();
  }

  /// A sub-table; null if it is absent.
  const toml::table* table_at(const toml::table& parent, std::string_view key) const {
    const toml::node* node = parent.get(key);
    if (node != nullptr && !node->is_table())
      fail(line_of(*node), "{}: expected a table, headed by its name in brackets", key);
    return node == nullptr ? nullptr : node->as_table();
  }

  void read_data_sheet() {
    const toml::table* drive = table_at(root_, "drive");
    if (drive == nullptr) fail(line_of(root_), "missing table [drive]; add the drive's data-sheet values");
    if (!drive->contains("kind")) require_fields(*drive);
    const std::string kind = text_at(*drive, "kind", "[drive]", true);
    if (kind != "rotary" && kind != "linear")
      fail(line_of(*drive->get("kind")), "kind: '{}' is unknown; write \"rotary\" or \"linear\"", kind);
    model_.data.kind = kind == "rotary" ? DriveKind::rotary : DriveKind::linear;
    refuse_unknown_in_drive(*drive);
    require_fields(*drive);
    for (const DataSheetField& field : kDataSheetFields)
      if (field.belongs_to(model_.data.kind)) read_field(*drive, field);
    if (const toml::table* scale = table_at(*drive, "load_encoder")) check_load_encoder(*scale);
    if (const toml::table* tach = table_at(*drive, "tach")) read_tachometer(*tach);
    const bool gives_volts = drive->contains(kForcePerVolt) || drive->contains("amplifier_gain_A_per_V");
    if (!gives_volts) take_current_alone(*drive);
  }

  void check_load_encoder(const toml::table& scale) const {
    const std::string_view unit = model_.data.kind == DriveKind::rotary ? "mm" : "m";
    if (!model_.data.has_load_encoder())
      fail(line_of(scale), "missing field resolution_{} in [drive.load_encoder]; add one count of the scale", unit);
    if ((model_.data.load_encoder_cyclic_error > 0.0) != (model_.data.load_encoder_cyclic_period > 0.0))
      fail(line_of(scale), "[drive.load_encoder]: cyclic_error_{0} and cyclic_period_{0} go together; add the other",
           unit);
  }

  /// Names all missing fields in one message. If the kind is missing, it is inferred from the present fields.
  void require_fields(const toml::table& drive) const {
    std::vector<std::string> missing;
    const bool speaks_of_force = drive.contains(kForcePerVolt) || drive.contains(kForcePerAmpere);
    const bool is_linear =
        drive.contains("kind") ? text_at(drive, "kind", "[drive]", true) == "linear" : speaks_of_force;
    const DriveKind kind = is_linear ? DriveKind::linear : DriveKind::rotary;
    if (!drive.contains("kind")) missing.emplace_back("kind = \"rotary\" or \"linear\"");
    for (const DataSheetField& field : kDataSheetFields)
      if (field.presence == Presence::required && field.belongs_to(kind) && !drive.contains(field.key))
        missing.push_back(fmt::format("{} = …", field.key));
    if (is_linear && !speaks_of_force)
      missing.push_back(fmt::format("{} = … ({} for logs of the current)", kForcePerVolt, kForcePerAmpere));
    if (const toml::table* tach = table_at(drive, "tach"); tach != nullptr && !tach->contains(tach_noise_key(kind)))
      missing.push_back(fmt::format("{} = … in [drive.tach], or remove this table if the drive has no tachometer",
                                    tach_noise_key(kind)));
    if (missing.empty()) return;
    fail(line_of(drive), "missing field{} in [drive]: {}; add {} from the data sheet", missing.size() == 1 ? "" : "s",
         fmt::join(missing, ", "), missing.size() == 1 ? "it" : "them");
  }

  /// Torque or force is given only per ampere, so the command is in amperes and has no limit.
  void take_current_alone(const toml::table& drive) {
    if (const toml::node* dac = drive.get("dac"))
      fail(line_of(*dac),
           "[drive.dac] is about volts, but [drive] gives torque or force only for the current; add {}, or remove "
           "[drive.dac]",
           model_.data.kind == DriveKind::rotary ? "amplifier_gain_A_per_V" : kForcePerVolt);
    know_by_current(model_.data);
  }

  void refuse_unknown_in_drive(const toml::table& drive) const {
    for (const DataSheetField& field : kDataSheetFields)
      if (const toml::node* node = drive.get(field.key);
          field.table.empty() && !field.belongs_to(model_.data.kind) && node != nullptr)
        fail(line_of(*node), "{} belongs to a {} drive, but kind is \"{}\"; remove the one that is wrong", field.key,
             *field.only == DriveKind::rotary ? "rotary" : "linear",
             *field.only == DriveKind::rotary ? "linear" : "rotary");
    refuse_unknown(drive, known_in(""), "in [drive]");
    for (const std::string_view name : {"dac", "encoder", "load_encoder"})
      if (const toml::table* table = table_at(drive, name))
        refuse_unknown(*table, known_in(name), fmt::format("in [drive.{}]", name));
    if (const toml::table* tach = table_at(drive, "tach"))
      refuse_unknown(*tach, {tach_noise_key(model_.data.kind)}, "in [drive.tach]");
  }

  Names known_in(std::string_view table) const {
    Names known;
    if (table.empty()) known = {"kind", "dac", "encoder", "load_encoder", "tach"};
    for (const DataSheetField& field : kDataSheetFields)
      if (field.table == table && field.belongs_to(model_.data.kind)) known.push_back(field.key);
    return known;
  }

  void read_field(const toml::table& drive, const DataSheetField& field) {
    const toml::table* table = field.table.empty() ? &drive : table_at(drive, field.table);
    const toml::node* node = table == nullptr ? nullptr : table->get(field.key);
    if (node == nullptr) return;
    for (const DataSheetField& other : kDataSheetFields)
      if (field.presence == Presence::alternative_unit && other.value == field.value && other.key != field.key &&
          table->contains(other.key))
        fail(line_of(*node), "{}: the same quantity is also given in another unit; keep one of them", field.key);
    model_.data.*field.value = positive_number(*node, field.key, field.zero_allowed) / field.divisor;
  }

  double positive_number(const toml::node& node, std::string_view key, bool zero_allowed) const {
    const double value = number_of(node, key);
    if (value < 0.0 || (value == 0.0 && !zero_allowed))
      fail(line_of(node), "{}: {} is out of bounds; it must be {}", key, value, zero_allowed ? "0 or more" : "above 0");
    return value;
  }

  void read_tachometer(const toml::table& tach) {
    const std::string_view key = tach_noise_key(model_.data.kind);
    model_.data.tach_noise_variance = positive_number(*tach.get(key), key, true);
  }

  void read_effects(bool required) {
    const toml::node* node = root_.get("effect");
    if (node == nullptr && !required) return;
    if (node == nullptr)
      fail(line_of(root_), "no [[effect]] in the model; identify the drive first (axistool identify RECORD --drive {})",
           name_);
    const toml::array* array = node->as_array();
    if (array == nullptr) fail(line_of(*node), "effect: write each effect under a heading [[effect]]");
    require_at_most(*array, kMostEffects, "effects", "a model");
    for (const toml::node& entry : *array) {
      if (!entry.is_table()) fail(line_of(entry), "effect: write each effect under a heading [[effect]]");
      read_effect(*entry.as_table());
    }
    if (required && model_.find("inertia") == nullptr)
      fail(line_of(*node), "missing effect inertia; add [[effect]] kind = \"inertia\"");
  }

  void require_at_most(const toml::array& list, std::size_t most, std::string_view what, std::string_view of) const {
    if (list.size() > most)
      fail(line_of(list), "{} {}, and {} may have at most {}; merge them", list.size(), what, of, most);
  }

  void read_effect(const toml::table& table) {
    sim::EffectEntry entry;
    entry.kind = text_at(table, "kind", "[[effect]]", true);
    const sim::EffectInfo* info = sim::find_effect(entry.kind);
    if (info == nullptr) {
      const Names kinds = effect_kinds();
      fail(line_of(*table.get("kind")), "kind: effect '{}' is unknown{} (known: {})", entry.kind,
           did_you_mean(entry.kind, kinds), fmt::join(kinds, ", "));
    }
    if (model_.find(entry.kind) != nullptr && !may_repeat(*info))
      fail(line_of(table), "effect {} is in the model twice; keep one of them", entry.kind);
    entry.from = text_at(table, "from", "[[effect]]", false);
    refuse_unknown_in_effect(table, *info);
    if (info->curve) {
      read_curve(table, *info, entry);
      model_.effects.push_back(std::move(entry));
      return;
    }
    for (const sim::ParameterInfo& parameter : info->parameters)
      read_parameter(table, parameter, std::string(parameter.id), entry);
    if (info->periodic) read_harmonics(table, *info, entry);
    require_parameters(table, *info, entry);
    model_.effects.push_back(std::move(entry));
  }

  /// Fields that each of these values may have.
  static std::vector<std::string> fields_beside(const Names& keys) {
    std::vector<std::string> fields;
    for (const std::string_view key : keys)
      for (const std::string_view suffix : {kIntervalSuffix, kHeldSuffix, kDeviationSuffix, kGivenSuffix})
        fields.push_back(fmt::format("{}{}", key, suffix));
    return fields;
  }

  void refuse_unknown_in_effect(const toml::table& table, const sim::EffectInfo& info) const {
    Names known = {"kind", "from"};
    for (const sim::ParameterInfo& parameter : info.parameters) known.push_back(parameter.key(model_.data.kind));
    const std::vector<std::string> beside = fields_beside({known.begin() + 2, known.end()});
    refuse_keys_of_other_kind(table, info, known);
    Names allowed = known;
    allowed.insert(allowed.end(), beside.begin(), beside.end());
    if (info.periodic) allowed.push_back(kHarmonics);
    if (info.curve) allowed.insert(allowed.end(), {"over", curve_deviation_key(model_.data.kind)});
    refuse_unknown(table, allowed, fmt::format("in effect {}", info.kind));
  }

  void refuse_keys_of_other_kind(const toml::table& table, const sim::EffectInfo& info, const Names& known) const {
    const bool rotary = model_.data.kind == DriveKind::rotary;
    for (const sim::ParameterInfo& parameter : info.parameters) {
      const std::string_view other = parameter.key(rotary ? DriveKind::linear : DriveKind::rotary);
      const toml::node* node = table.get(other);
      if (node != nullptr && std::ranges::find(known, other) == known.end())
        fail(line_of(*node), "{} belongs to a {} drive; this one is {}: give {}", other, rotary ? "linear" : "rotary",
             rotary ? "rotary" : "linear", parameter.key(model_.data.kind));
    }
  }

  std::vector<double> numbers_at(const toml::table& table, std::string_view key) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) fail(line_of(table), "missing field {} in effect free_curve; add {} = [ … ]", key, key);
    const toml::array* list = node->as_array();
    if (list == nullptr) fail(line_of(*node), "{}: write a list, [ … ]", key);
    require_at_most(*list, kMostKnots, key, "a curve");
    std::vector<double> numbers;
    for (const toml::node& element : *list) numbers.push_back(number_of(element, key));
    return numbers;
  }

  /// A curve: `over`, `knots`, the values, and their standard deviations if they are known.
  void read_curve(const toml::table& table, const sim::EffectInfo& info, sim::EffectEntry& entry) const {
    entry.over = text_at(table, "over", "[[effect]] free_curve", true);
    if (std::ranges::find(sim::kCurveCoordinates, entry.over) == std::end(sim::kCurveCoordinates))
      fail(line_of(*table.get("over")), "over: '{}' is unknown; write one of {}", entry.over,
           fmt::join(sim::kCurveCoordinates, ", "));
    const std::string_view knots_key = info.parameter("knot")->key(model_.data.kind);
    const std::string_view values_key = info.parameter("value")->key(model_.data.kind);
    const std::string_view deviation_key = curve_deviation_key(model_.data.kind);
    const std::vector<double> knots = numbers_at(table, knots_key), values = numbers_at(table, values_key);
    if (knots.size() < 2 || knots.size() != values.size())
      fail(line_of(table), "{} and {} must have the same length, two or more: {} and {}", knots_key, values_key,
           knots.size(), values.size());
    if (!std::ranges::is_sorted(knots, std::less_equal{}))
      fail(line_of(*table.get(knots_key)), "{}: each must be above the one before", knots_key);
    if (entry.over == "phase" && values.front() != values.back())
      fail(line_of(*table.get(values_key)), "{}: over phase the curve is periodic: the last value must equal the first",
           values_key);
    std::vector<double> deviations;
    if (table.contains(deviation_key)) deviations = numbers_at(table, deviation_key);
    for (std::size_t n = 0; n < knots.size(); ++n) {
      entry.parameters[sim::numbered_id("knot", static_cast<double>(n))] = knots[n];
      const std::string id = sim::numbered_id("value", static_cast<double>(n));
      entry.parameters[id] = values[n];
      if (deviations.size() == values.size())
        entry.ci95[id] = {values[n] - kNormal95 * deviations[n], values[n] + kNormal95 * deviations[n]};
    }
  }

  /// The orders of a period, if they are given as a list instead of a single pair.
  void read_harmonics(const toml::table& table, const sim::EffectInfo& info, sim::EffectEntry& entry) const {
    const toml::node* node = table.get(kHarmonics);
    if (node == nullptr) return;
    const sim::ParameterInfo &cosine = *info.parameter("cosine"), &sine = *info.parameter("sine");
    const std::string_view cosine_key = cosine.key(model_.data.kind), sine_key = sine.key(model_.data.kind);
    const std::string form =
        fmt::format("{} = [ {{ order = 1, {} = …, {} = … }}, … ]", kHarmonics, cosine_key, sine_key);
    if (entry.has("cosine") || entry.has("sine"))
      fail(line_of(*node), "{} is given as well as {} or {}; keep one form", kHarmonics, cosine_key, sine_key);
    const toml::array* list = node->as_array();
    if (list == nullptr || list->empty()) fail(line_of(*node), "{}: write {}", kHarmonics, form);
    require_at_most(*list, kMostHarmonics, kHarmonics, "an effect");
    for (const toml::node& element : *list) {
      const toml::table* term = element.as_table();
      const toml::node* order_node = term == nullptr ? nullptr : term->get("order");
      if (order_node == nullptr) fail(line_of(element), "{}: write {}", kHarmonics, form);
      const double order = positive_number(*order_node, "order", false);
      Names known = {"order", cosine_key, sine_key};
      const std::vector<std::string> beside = fields_beside({cosine_key, sine_key});
      known.insert(known.end(), beside.begin(), beside.end());
      refuse_unknown(*term, known, fmt::format("in {} of effect {}", kHarmonics, info.kind));
      for (const auto& [parameter, family] : {std::pair(&cosine, "cosine"), std::pair(&sine, "sine")}) {
        const std::string id = sim::harmonic_id(family, order);
        if (entry.has(id)) fail(line_of(element), "{}: order {} is given twice; keep one of them", kHarmonics, order);
        read_parameter(*term, *parameter, id, entry);
        if (!entry.has(id))
          fail(line_of(element), "{}: order {} lacks {}; add it", kHarmonics, order, parameter->key(model_.data.kind));
      }
    }
  }

  void read_parameter(const toml::table& table, const sim::ParameterInfo& parameter, const std::string& id,
                      sim::EffectEntry& entry) const {
    const std::string key(parameter.key(model_.data.kind));
    const toml::node* node = table.get(key);
    const std::string interval_key = key + std::string(kIntervalSuffix);
    const toml::node* interval = table.get(interval_key);
    const std::string held_key = key + std::string(kHeldSuffix), deviation_key = key + std::string(kDeviationSuffix);
    const std::string given_key = key + std::string(kGivenSuffix);
    const toml::node *held = table.get(held_key), *deviation = table.get(deviation_key), *given = table.get(given_key);
    for (const auto& [beside, name] : {std::pair(interval, &interval_key), std::pair(held, &held_key),
                                       std::pair(deviation, &deviation_key), std::pair(given, &given_key)})
      if (node == nullptr && beside != nullptr)
        fail(line_of(*beside), "{} is given without {}; add the value, or remove {}", *name, key, *name);
    if (node == nullptr) return;
    const double value = number_of(*node, key);
    if (bounds_ == Bounds::enforced && (value < parameter.lower || value > parameter.upper))
      fail(line_of(*node), "{}: {} is out of bounds ({}); it must lie within {} … {}", key, value, parameter.doc,
           parameter.lower, parameter.upper);
    entry.parameters[id] = value;
    if (interval != nullptr) entry.ci95[id] = interval_of(*interval, interval_key, value);
    if (held != nullptr && !held->is_boolean()) fail(line_of(*held), "{}: write true or false", held_key);
    if (held != nullptr && held->as_boolean()->get()) entry.held.insert(id);
    if (deviation != nullptr)
      entry.believed[id] = {given == nullptr ? value : number_of(*given, given_key),
                            positive_number(*deviation, deviation_key, false)};
    else if (given != nullptr)
      fail(line_of(*given), "{} is given without {}; add it, or remove {}", given_key, deviation_key, given_key);
  }

  std::array<double, 2> interval_of(const toml::node& node, std::string_view key, double value) const {
    const toml::array* ends = node.as_array();
    if (ends == nullptr || ends->size() != 2) fail(line_of(node), "{}: write the interval as [low, high]", key);
    const std::array<double, 2> interval = {number_of(*ends->get(0), key), number_of(*ends->get(1), key)};
    if (interval[0] > interval[1])
      fail(line_of(node), "{}: its low end {} is above its high end {}; swap them", key, interval[0], interval[1]);
    if (!holds(interval, value))
      fail(line_of(node),
           "{}: the interval {} … {} does not hold the value {}; remove the one that is not from this fit", key,
           interval[0], interval[1], value);
    return interval;
  }

  /// Every parameter must be present, in one of the forms that the effect allows.
  void require_parameters(const toml::table& table, const sim::EffectInfo& info, const sim::EffectEntry& entry) const {
    for (const sim::ParameterInfo& parameter : info.parameters) {
      if (!parameter.pair_of.empty())
        require_one_form(table, info, parameter, entry);
      else if (!parameter.optional && !entry.has_any(parameter.id))
        fail(line_of(table), "missing field {} in effect {} ({}); add it", parameter.key(model_.data.kind), info.kind,
             parameter.doc);
    }
    if (info.kind == "nonlinear_viscous" && entry.has("exponent") == entry.has("saturation"))
      fail(line_of(table), "effect {} takes one form: give {} or {}", info.kind,
           info.parameter("exponent")->key(model_.data.kind), info.parameter("saturation")->key(model_.data.kind));
  }

  void require_one_form(const toml::table& table, const sim::EffectInfo& info, const sim::ParameterInfo& both,
                        const sim::EffectEntry& entry) const {
    Names keys, missing;
    for (const std::string_view id : ids_of_pair(both)) {
      keys.push_back(info.parameter(id)->key(model_.data.kind));
      if (!entry.has(std::string(id))) missing.push_back(keys.back());
    }
    const std::string_view single = both.key(model_.data.kind);
    if (entry.has(std::string(both.id)) && missing.size() < keys.size())
      fail(line_of(*table.get(single)), "{} is given together with a value for one direction ({}); keep one form",
           single, fmt::join(keys, ", "));
    if (!entry.has(std::string(both.id)) && !missing.empty())
      fail(line_of(table), "missing field {} in effect {}; give {}, or {} for both directions", missing.front(),
           info.kind, fmt::join(keys, " and "), single);
  }

  std::string_view name_;
  Bounds bounds_;
  toml::table root_;
  sim::DriveDescription model_;
};

}  // namespace

sim::DriveDescription parse_model(std::string_view text, std::string_view name, Bounds bounds) {
  return ModelReader(text, name, bounds).read(true);
}

sim::DriveDescription parse_drive(std::string_view text, std::string_view name) {
  return ModelReader(text, name).read(false);
}

sim::DriveDescription read_model(const std::string& path, Bounds bounds) {
  return parse_model(read_file(path), path, bounds);
}

sim::DriveDescription read_drive(const std::string& path) { return parse_drive(read_file(path), path); }

}  // namespace host
