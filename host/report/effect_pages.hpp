// The catalogue of effects as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "host/report/terminal.hpp"
#include "sim/drive_description.hpp"
#include "sim/effect.hpp"

namespace host {

/// Every kind with its title and one line on how it shows, grouped by stage of the drive's signal path.
std::string effect_list(const Terminal& terminal);

/// The complete catalogue entry of one effect, with an example for each kind of drive.
std::string effect_page(const sim::EffectInfo& info, const Terminal& terminal);

/// An entry for a model file, with values that are typical of a drive of some kilowatts. Uses the form with one value
/// for both directions, if there is one.
std::string effect_example_toml(const sim::EffectInfo& info, sim::DriveKind kind);

/// The model with that entry added. Throws Failure(bad_input) if the model cannot take the effect.
sim::DriveDescription with_example(const sim::DriveDescription& model, const sim::EffectInfo& info);

/// "axis-effects/1": the whole catalogue, or one effect.
nlohmann::json effects_json();
nlohmann::json effects_json(const sim::EffectInfo& info);

}  // namespace host
