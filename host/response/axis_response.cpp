#include "host/response/axis_response.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "host/exit_codes.hpp"
#include "host/read_file.hpp"
#include "host/response/axis_controller.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

using nlohmann::json;

/// By FrequencyResponse::Method.
constexpr std::array kMethodNames{"periodic", "welch", "model"};

json complex_json(const std::vector<std::complex<double>>& values, const std::vector<double>& half_width) {
  json re = json::array(), im = json::array(), sd = json::array();
  for (const std::complex<double>& value : values) {
    re.push_back(value.real());
    im.push_back(value.imag());
  }
  for (const double reach : half_width) sd.push_back(reach / kNormal95);
  return {{"re", re}, {"im", im}, {"sd", sd}};
}

json plant_json(const FrequencyResponse& response, Eigen::Index channel) {
  std::vector<std::complex<double>> values;
  std::vector<double> half_width;
  for (const ResponseLine& line : response.lines) {
    values.push_back(line.plant(channel));
    half_width.push_back(half_width_95(line, Eigen::Vector2cd::Unit(channel)));
  }
  json plant = complex_json(values, half_width);
  plant["unit"] = plant_unit(response, channel);
  return plant;
}

json interval_json(const std::optional<Interval95>& interval) {
  if (!interval) return nullptr;
  return {{"value", interval->value}, {"ci95", interval->ci95}};
}

json margins_json(const LoopMargins& margins) {
  return {{"gain_dB", interval_json(margins.gain_dB)}, {"phase_deg", interval_json(margins.phase_deg)},
          {"modulus", interval_json(margins.modulus)}, {"crossover_Hz", interval_json(margins.crossover_Hz)},
          {"modulus_at_Hz", margins.modulus_at_Hz},    {"stable", margins.is_stable}};
}

json fit_json(const PlantFit& fit) {
  return {{"position_gain", fit.position_gain},    {"speed_gain", fit.speed_gain},      {"pole_rad_s", fit.pole},
          {"delay_s", interval_json(fit.delay_s)}, {"lag_s", interval_json(fit.lag_s)}, {"misfit", fit.misfit}};
}

template <typename Pick>
json list_of(const std::vector<ResponseLine>& lines, const Pick& pick) {
  json list = json::array();
  for (const ResponseLine& line : lines) list.push_back(pick(line));
  return list;
}

json distortion_json(const std::vector<DistortionLine>& lines) {
  json f_Hz = json::array(), level = json::array();
  for (const DistortionLine& line : lines) {
    f_Hz.push_back(line.f_Hz);
    level.push_back(line.level);
  }
  return {{"f_Hz", f_Hz}, {"level", level}};
}

/// Empty for a document of an older version without distortion.
std::vector<DistortionLine> read_distortion(const json& document, const char* which) {
  std::vector<DistortionLine> lines;
  if (!document.contains("distortion")) return lines;
  const json& part = document["distortion"].at(which);
  for (std::size_t i = 0; i < part.at("f_Hz").size(); ++i)
    lines.push_back({part["f_Hz"][i].get<double>(), part.at("level").at(i).get<double>()});
  return lines;
}

/// Squared limits of plausible magnitudes of a drive: 1e-9 to 1e9 in the plant's unit.
constexpr double kLeast = 1e-18, kMost = 1e18;

bool is_one_of_a_drive(const ResponseLine& line, const FrequencyResponse& response) {
  for (Eigen::Index channel = 0; channel < 2; ++channel) {
    if (!(channel == 0 ? response.has_position : response.has_speed)) continue;
    const double size = std::abs(line.plant(channel)), variance = line.covariance(channel, channel).real();
    if (!(size > kLeast && size < kMost && variance >= 0.0 && variance < kMost * kMost)) return false;
  }
  const auto is_sized = [](double value) { return value >= 0.0 && value < kMost; };
  return is_sized(line.noise) && is_sized(line.nonlinearity) && is_sized(line.degrees) && line.coherence >= 0.0 &&
         line.coherence <= 1.0 && std::isfinite(std::abs(line.covariance(0, 1)));
}

/// Throws Failure(bad_input) naming the first impossible entry.
void require_measured(const FrequencyResponse& response, const std::string& path) {
  const auto refuse = [&](const std::string& what) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: {}; write it again with `axistool bode --json`", path, what));
  };
  constexpr double kShortest_s = 1e-6, kLongest_s = 1.0;
  if (!(response.sample_period_s >= kShortest_s && response.sample_period_s <= kLongest_s))
    refuse(fmt::format("sample_period_s = {:g}: it must be from {:g} to {:g}", response.sample_period_s, kShortest_s,
                       kLongest_s));
  double last_Hz = 0.0;
  for (std::size_t i = 0; i < response.lines.size(); ++i) {
    const ResponseLine& line = response.lines[i];
    if (!(line.f_Hz > last_Hz && line.f_Hz * response.sample_period_s < 1.0))
      refuse(fmt::format("f_Hz[{}] = {:g}: frequencies must increase, from above 0 to below {:g}", i, line.f_Hz,
                         1.0 / response.sample_period_s));
    last_Hz = line.f_Hz;
    if (!is_one_of_a_drive(line, response))
      refuse(
          fmt::format("entry {} of plant, covariance, noise, nonlinearity, coherence or degrees is not finite or out "
                      "of any drive's range",
                      i));
  }
}

/// Cross-covariance of the two channels: needed with "sd" for the margins' intervals.
json covariance_json(const ResponseLine& line) {
  const Eigen::Matrix2cd& c = line.covariance;
  return {c(0, 0).real(), c(1, 1).real(), c(0, 1).real(), c(0, 1).imag()};
}

}  // namespace

AxisResponse with_controller(const AxisResponse& measured, const firmware::AxisParameters<float>& controller) {
  AxisResponse axis = measured;
  axis.loop.reset();
  axis.margins.reset();
  if (!axis.fit) return axis;
  const AxisController law(controller);
  axis.loop = open_loop(axis.response, *axis.fit, law);
  axis.margins = margins_of(axis.response, *axis.fit, law);
  return axis;
}

AxisResponse analyse_response(const std::vector<Record>& records, const firmware::AxisParameters<float>* controller) {
  AxisResponse axis;
  axis.response = frequency_response(records);
  try {
    axis.fit = fit_plant(axis.response);
  } catch (const Failure& failure) {
    axis.response.warnings.push_back(failure.what());
  }
  return controller != nullptr ? with_controller(axis, *controller) : axis;
}

nlohmann::json response_json(const AxisResponse& axis) {
  const FrequencyResponse& response = axis.response;
  json document = {
      {"format", "axis-response/1"},
      {"method", kMethodNames.at(static_cast<std::size_t>(response.method))},
      {"indirect", response.is_indirect},
      {"kind", response.kind == sim::DriveKind::rotary ? "rotary" : "linear"},
      {"sample_period_s", response.sample_period_s},
      {"realisations", response.realisations},
      {"periods", response.periods},
      {"f_Hz", list_of(response.lines, [](const ResponseLine& line) { return line.f_Hz; })},
      {"plant", plant_json(response, response.channel())},
      {"noise", list_of(response.lines, [](const ResponseLine& line) { return line.noise; })},
      {"nonlinearity", list_of(response.lines, [](const ResponseLine& line) { return line.nonlinearity; })},
      {"distortion", {{"even", distortion_json(response.even)}, {"odd", distortion_json(response.odd)}}},
      {"coherence", list_of(response.lines, [](const ResponseLine& line) { return line.coherence; })},
      {"degrees", list_of(response.lines, [](const ResponseLine& line) { return line.degrees; })},
      {"covariance", list_of(response.lines, covariance_json)},
      {"has_position", response.has_position},
      {"has_speed", response.has_speed},
      {"warnings", response.warnings}};
  if (response.has_position && response.has_speed) document["plant_speed"] = plant_json(response, 1);
  document["open_loop"] = axis.loop ? complex_json(axis.loop->L, axis.loop->half_width) : json(nullptr);
  document["margins"] = axis.margins ? margins_json(*axis.margins) : json(nullptr);
  document["fit"] = axis.fit ? fit_json(*axis.fit) : json(nullptr);
  document["resonances"] = json::array();
  if (axis.fit)
    for (const Resonance& mode : axis.fit->resonances)
      document["resonances"].push_back({{"f_Hz", mode.f_Hz.value},
                                        {"ci95", mode.f_Hz.ci95},
                                        {"damping", mode.damping.value},
                                        {"damping_ci95", mode.damping.ci95},
                                        {"position_share", mode.position_share},
                                        {"speed_share", mode.speed_share}});
  return document;
}

AxisResponse read_response(const std::string& path) {
  AxisResponse axis;
  FrequencyResponse& response = axis.response;
  try {
    const json document = json::parse(read_file(path));
    if (document.at("format") != "axis-response/1")
      throw Failure(ExitCode::bad_input, path + ": is not axis-response/1");
    response.method =
        document.at("method") == "welch" ? FrequencyResponse::Method::welch : FrequencyResponse::Method::periodic;
    response.is_indirect = document.at("indirect");
    response.kind = document.at("kind") == "linear" ? sim::DriveKind::linear : sim::DriveKind::rotary;
    response.sample_period_s = document.at("sample_period_s");
    response.realisations = document.at("realisations");
    response.periods = document.at("periods");
    response.has_position = document.at("has_position");
    response.has_speed = document.at("has_speed");
    response.warnings = document.at("warnings").get<std::vector<std::string>>();
    const auto value = [&](const char* plant, std::size_t i) {
      return std::complex<double>(document.at(plant).at("re").at(i), document.at(plant).at("im").at(i));
    };
    const char* speed = response.has_position ? "plant_speed" : "plant";
    for (std::size_t i = 0; i < document.at("f_Hz").size(); ++i) {
      ResponseLine line;
      line.f_Hz = document["f_Hz"][i];
      if (response.has_position) line.plant(0) = value("plant", i);
      if (response.has_speed) line.plant(1) = value(speed, i);
      const json& products = document.at("covariance").at(i);
      const std::complex<double> cross(products.at(2), products.at(3));
      line.covariance << products.at(0).get<double>(), cross, std::conj(cross), products.at(1).get<double>();
      line.noise = document.at("noise").at(i);
      line.nonlinearity = document.at("nonlinearity").at(i);
      line.coherence = document.at("coherence").at(i);
      line.degrees = document.at("degrees").at(i);
      response.lines.push_back(line);
    }
    response.even = read_distortion(document, "even");
    response.odd = read_distortion(document, "odd");
  } catch (const json::exception& error) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: {}: not a response that `axistool bode --json` wrote", path, error.what()));
  }
  require_measured(response, path);
  axis.fit = fit_plant(response);
  return axis;
}

}  // namespace host
