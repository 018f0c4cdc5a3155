#include "host/device/board_report.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "firmware/app/parameters/parameter_values.hpp"
#include "firmware/app/store/parameter_store.hpp"
#include "firmware/core/supervision/fault_table.hpp"
#include "firmware/core/supervision/supervisor_state.hpp"

namespace host {

namespace {

template <std::size_t size>
std::string text_of(const std::array<char, size>& padded) {
  return std::string(padded.data(), std::string_view(padded.data(), size).find_last_not_of('\0') + 1);
}

template <typename Names>
std::string nth(const Names& names, std::size_t n) {
  return n < names.size() ? std::string(names[n]) : fmt::format("number {}", n);
}

}  // namespace

const char* fault_name(std::uint8_t fault) {
  return firmware::fault_info(static_cast<firmware::AxisFault>(fault)).name;
}

bool is_linear(std::size_t axis, const firmware::ParameterValues& values) {
  return values.axis(axis).get<"drive.lead">() == 1.0F;
}

const char* travel_unit(std::size_t axis, const firmware::ParameterValues& values) {
  return is_linear(axis, values) ? "m" : "mm";
}

std::optional<AxisPlace> place_of_counts(std::int64_t counts, std::size_t axis,
                                         const firmware::ParameterValues* values) {
  if (values == nullptr || axis >= values->axes() || !values->axis(axis).get<"drive.fitted">()) return {};
  const auto drive = values->axis(axis);
  const double resolution = static_cast<double>(drive.get<"drive.encoder_resolution">());
  return AxisPlace{static_cast<double>(counts) * resolution, travel_unit(axis, *values)};
}

std::string state_text(const firmware::AxisStatus& axis) {
  std::string state = nth(firmware::kStateNames, axis.state);
  if ((axis.flags & firmware::kAxisFitted) != 0) return state;
  // An experiment moves it in open loop.
  const bool is_on = firmware::outputs_are_on(static_cast<firmware::SupervisorState>(axis.state));
  return is_on ? state + ", not fitted" : "not fitted";
}

std::string store_text(std::uint8_t store_state) {
  constexpr std::array<std::string_view, 5> kNames{"empty", "loaded", "migrated", "incomplete", "damaged"};
  return nth(kNames, store_state);
}

std::string reset_text(std::uint8_t reset_cause) {
  constexpr std::array<std::string_view, 7> kNames{"unknown",  "power on", "reset pin", "software",
                                                   "watchdog", "fault",    "brown-out"};
  return nth(kNames, reset_cause);
}

std::string brown_out_problem() {
  return "the chip's brown-out reset is off (factory setting): while its supply fails it may do anything, so no "
         "drive is enabled. `axistool flash` sets it, by a probe or over USB; or STM32_Programmer_CLI -c port=SWD -ob "
         "BOR_LEV=0";
}

std::optional<std::string> store_problem(const BoardState& status) {
  switch (static_cast<firmware::StoreState>(status.store_state)) {
    case firmware::StoreState::damaged:
      return "the saved parameters are damaged, the drives stay disabled: `axistool restore BACKUP`, or set-params and "
             "save";
    case firmware::StoreState::incomplete:
      return fmt::format(
          "{} saved parameters do not fit this firmware, the drives stay disabled: `axistool backup` "
          "shows them; set what is right and save",
          status.not_migrated);
    case firmware::StoreState::empty:
    case firmware::StoreState::loaded:
    case firmware::StoreState::migrated:
      break;
  }
  return std::nullopt;
}

std::string fault_text(std::uint8_t fault, std::uint8_t second_fault) {
  if (fault == 0) return "";
  std::string text = fmt::format("fault {} {}", fault, fault_name(fault));
  if (second_fault != 0) text += fmt::format(", then {} {}", second_fault, fault_name(second_fault));
  return text;
}

nlohmann::json board_json(const std::string& device, const firmware::IdentityPayload& identity,
                          const BoardState& status, const firmware::TimingPayload& timing,
                          const firmware::ParameterValues* values) {
  nlohmann::json axes = nlohmann::json::array();
  for (std::size_t axis = 0; axis < status.axis.size(); ++axis) {
    const firmware::AxisStatus& now = status.axis[axis];
    axes.push_back({{"axis", firmware::kAxisNames[axis]},
                    {"state", state_text(now)},
                    {"fault", fault_name(now.fault)},
                    {"second_fault", fault_name(now.second_fault)},
                    {"counts", now.counts()},
                    {"velocity", now.velocity},
                    {"saturated", (now.flags & firmware::kAxisSaturated) != 0},
                    {"at_rest", (now.flags & firmware::kAxisAtRest) != 0},
                    {"homed", (now.flags & firmware::kAxisHomed) != 0},
                    {"pitch_corrected", (now.flags & firmware::kAxisPitch) != 0},
                    {"friction_taken_back", (timing.friction_taken_back >> axis & 1u) != 0}});
    if (const auto place = place_of_counts(now.counts(), axis, values))
      axes.back().update({{"position", place->value}, {"position_unit", place->unit}});
  }
  return {{"format", "axis-board/1"},
          {"device", device},
          {"board", text_of(identity.board)},
          {"version", text_of(identity.version)},
          {"git_hash", text_of(identity.git_hash)},
          {"schema_hash", identity.schema_hash},
          {"same_table", identity.schema_hash == firmware::kSchemaHash},
          {"fixed_point", identity.fixed_point != 0},
          {"simulated", (status.flags & firmware::kBoardSimulated) != 0},
          {"control_periods", status.control_periods},
          {"control_cycles",
           {{"average", timing.cycles_average}, {"worst", timing.cycles_worst}, {"processor_Hz", timing.processor_Hz}}},
          {"store", store_text(status.store_state)},
          {"unsaved_changes", (status.flags & firmware::kBoardUnsaved) != 0},
          {"erases", status.store_erases},
          {"reset_cause", reset_text(status.reset_cause)},
          {"resets", status.resets},
          {"brown_out_reset", (status.flags & firmware::kBoardBrownOutOff) == 0},
          {"emergency_stop", (status.flags & firmware::kBoardStopPressed) != 0},
          {"left_alone", (status.flags & firmware::kBoardLeftAlone) != 0},
          {"axes", axes}};
}

std::string board_text(const std::string& device, const firmware::IdentityPayload& identity, const BoardState& status,
                       const firmware::TimingPayload& timing, const firmware::ParameterValues* values) {
  std::string text =
      fmt::format("device       {}\nboard        {}{}, version {} {}\nnumbers      {}\nparameters   table {:#010x}{}\n",
                  device, text_of(identity.board),
                  (status.flags & firmware::kBoardSimulated) != 0 ? " (simulated)" : "", text_of(identity.version),
                  text_of(identity.git_hash), identity.fixed_point != 0 ? "fixed point" : "float", identity.schema_hash,
                  identity.schema_hash == firmware::kSchemaHash ? ", as this axistool's" : ", NOT this axistool's");
  text += fmt::format("store        {}{}; flash erased {} times\n", store_text(status.store_state),
                      (status.flags & firmware::kBoardUnsaved) != 0 ? ", unsaved changes" : "", status.store_erases);
  if (timing.processor_Hz != 0)
    text += fmt::format("control      {} clocks of the processor on average, {} at worst, at {:g} MHz\n",
                        timing.cycles_average, timing.cycles_worst, 1e-6 * timing.processor_Hz);
  text += fmt::format("last reset   {}; {} since power on\n", reset_text(status.reset_cause), status.resets);
  if ((status.flags & firmware::kBoardBrownOutOff) != 0) text += brown_out_problem() + "\n";
  if ((status.flags & firmware::kBoardStopPressed) != 0) text += "emergency stop is pressed\n";
  if ((status.flags & firmware::kBoardLeftAlone) != 0)
    text += "the axes were disabled after host.standing_timeout without a program\n";
  for (std::size_t axis = 0; axis < status.axis.size(); ++axis) {
    const firmware::AxisStatus& now = status.axis[axis];
    const auto place = place_of_counts(now.counts(), axis, values);
    text += fmt::format(
        "axis {}       {}, {}{}{}{}{}\n", firmware::kAxisNames[axis], state_text(now),
        place ? fmt::format("{:.4f} {}", place->value, place->unit) : fmt::format("{} counts", now.counts()),
        (now.flags & firmware::kAxisHoming) != 0  ? ", looks for home"
        : (now.flags & firmware::kAxisHomed) != 0 ? " from home"
                                                  : " from where it was (not homed)",
        (now.flags & firmware::kAxisPitch) != 0 ? ", pitch error taken off" : "",
        (timing.friction_taken_back >> axis & 1u) != 0 ? ", friction feed-forward taken back" : "",
        now.fault == 0 ? "" : ", " + fault_text(now));
  }
  if (const auto problem = store_problem(status)) text += *problem + "\n";
  return text;
}

}  // namespace host
