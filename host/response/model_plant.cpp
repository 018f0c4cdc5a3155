#include <cmath>
#include <numbers>

#include "host/identify/linear_axis.hpp"
#include "host/record/read_record.hpp"
#include "host/response/axis_response.hpp"
#include "host/response/plant_fit.hpp"

namespace host {

PlantFit plant_of(const sim::DriveDescription& model) {
  const RigidAxis axis = rigid_axis(model);
  PlantFit fit;
  fit.sample_period_s = model.data.sample_period_s;
  fit.position_gain = axis.gain() * axis.lead;
  fit.speed_gain = axis.gain();
  fit.pole = -axis.pole();
  if (const sim::EffectEntry* const delay = model.find("input_delay")) fit.delay_s.value = delay->at("delay");
  if (const sim::EffectEntry* const lag = model.find("current_loop_lag"))
    fit.lag_s.value = 1.0 / (2.0 * std::numbers::pi * lag->at("bandwidth"));
  if (const sim::EffectEntry* const spring = model.find("compliance")) {
    const double load = spring->at("load_fraction"), share = load / (1.0 - load);
    fit.resonances.push_back({{spring->at("resonance"), {}}, {spring->at("damping_ratio"), {}}, share, share});
  }
  return fit;
}

AxisResponse modelled_response(const sim::DriveDescription& model) {
  constexpr int kLines = 160;
  constexpr double kLowest_Hz = 0.5, kHighestShare = 0.45, kRelativeVariance = 1e-12, kDegrees = 1e3;
  AxisResponse axis;
  axis.fit = plant_of(model);
  FrequencyResponse& response = axis.response;
  response.method = FrequencyResponse::Method::model;
  response.kind = model.data.kind;
  response.sample_period_s = model.data.sample_period_s;
  response.has_position = true;
  response.has_speed = model.data.tach_noise_variance.has_value();
  const double highest_Hz = kHighestShare / model.data.sample_period_s;
  for (int k = 0; k < kLines; ++k) {
    ResponseLine line;
    line.f_Hz = kLowest_Hz * std::pow(highest_Hz / kLowest_Hz, k / (kLines - 1.0));
    line.plant = axis.fit->at(line.f_Hz);
    line.covariance.diagonal() = kRelativeVariance * line.plant.cwiseAbs2().cast<std::complex<double>>();
    line.degrees = kDegrees;
    response.lines.push_back(line);
  }
  return axis;
}

AxisResponse response_of(const std::vector<std::string>& files, const sim::DriveDescription& model) {
  if (files.size() == 1 && files.front() == kModelled) return modelled_response(model);
  if (files.size() == 1 && files.front().ends_with(".json")) return read_response(files.front());
  std::vector<Record> records;
  for (const std::string& path : files) records.push_back(read_record(path));
  return analyse_response(records, nullptr);
}

}  // namespace host
