// From records to everything that a frequency response says of an axis.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "firmware/core/axis_parameters.hpp"
#include "host/response/frequency_response.hpp"
#include "host/response/loop_margins.hpp"
#include "host/response/plant_fit.hpp"

namespace host {

struct AxisResponse {
  FrequencyResponse response;
  std::optional<PlantFit> fit;         ///< absent where too few lines stand out
  std::optional<OpenLoop> loop;        ///< with a controller only, and a fit
  std::optional<LoopMargins> margins;  ///< likewise
};

/// `controller`: what the axis runs, or shall run; nullptr: none is known. Throws what frequency_response(),
/// open_loop() throw.
AxisResponse analyse_response(const std::vector<Record>& records, const firmware::AxisParameters<float>* controller);

/// The same response with another controller.
AxisResponse with_controller(const AxisResponse& measured, const firmware::AxisParameters<float>& controller);

/// `axis-response/1`. "plant" is position (or speed where there is none) over the command; "plant_speed" beside it
/// where both were recorded. "sd" is the standard deviation of each part of a complex value, with Student's factor in
/// it: 1.96 sd to either side hold 95 %. "distortion": what even and odd powers answer at lines that are not excited.
nlohmann::json response_json(const AxisResponse& axis);

/// Reads the measured part of such a document back. Throws Failure(bad_input).
AxisResponse read_response(const std::string& path);

}  // namespace host
