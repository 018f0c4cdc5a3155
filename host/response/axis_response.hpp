// From records to the frequency response of an axis, its fit and its margins.
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
  std::optional<PlantFit> fit;         ///< absent if too few lines are significant
  std::optional<OpenLoop> loop;        ///< only with a controller and a fit
  std::optional<LoopMargins> margins;  ///< likewise
};

/// `controller`: the present or a future controller of the axis; nullptr if unknown. Throws as frequency_response() and
/// open_loop().
AxisResponse analyse_response(const std::vector<Record>& records, const firmware::AxisParameters<float>* controller);

/// The same response with another controller.
AxisResponse with_controller(const AxisResponse& measured, const firmware::AxisParameters<float>& controller);

/// The response that the model predicts (plant_of), free of noise, from 0.5 Hz to close below half the sampling rate.
AxisResponse modelled_response(const sim::DriveDescription& model);

/// The word that stands for it where files of a measured response are expected.
inline constexpr const char* kModelled = "model";

/// The response in the files of an axis: kModelled alone, the JSON of `axistool bode`, or records. Throws as
/// read_response() and frequency_response().
AxisResponse response_of(const std::vector<std::string>& files, const sim::DriveDescription& model);

/// `axis-response/1`. "plant" is position (without one: speed) over the command; "plant_speed" beside it if both were
/// recorded. "sd": standard deviation of the real and of the imaginary part, including Student's factor, so that +-1.96
/// sd is the 95 % interval. "distortion": response of even and odd nonlinearity at lines without excitation.
nlohmann::json response_json(const AxisResponse& axis);

/// Reads the measured part of such a document back. Throws Failure(bad_input).
AxisResponse read_response(const std::string& path);

}  // namespace host
