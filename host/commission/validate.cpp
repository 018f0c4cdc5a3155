// Further motions for training and validation; one validation motion is made twice.
#include <fmt/format.h>

#include <algorithm>

#include "host/commission/steps.hpp"

namespace host {

CommissionRun judging_jogs(const CommissionSession& session, const std::string& file) {
  constexpr double kHold_s = 0.8;  // or less, if the box ends first
  std::vector<double> speeds;
  for (const double share : {0.01, 0.05, 0.18, 0.5, 0.95}) speeds.push_back(share * session.top_speed());
  return {file, "ladder", {speeds, {{"hold", kHold_s}}}, "", 2.5 * kHold_s * static_cast<double>(speeds.size())};
}

CommissionStepResult record_validation(CommissionSession& session) {
  session.ask("Validate: strokes with a multisine, reversals, rests, jogs and steps of other sizes.");
  session.download(session.with_file(session.folder().require("first-params.toml", "control")));
  const ExcitationLimits& box = session.options().box;
  const double top = std::min(session.steady_speed(), session.top_speed()),
               count = session.options().sheet.data.encoder_resolution;
  // Large enough to move the axis, too small to reverse the jog.
  session.record({"sweep.csv",
                  "multisine",
                  {{}, {{"amplitude", 0.2 * box.volts}, {"from", 2.0}, {"to", 80.0}, {"ride", 0.2 * top}}},
                  "output",
                  8.0});
  // A triangle of the reference holds 1000 counts; its corners are as sharp as the board allows for a path.
  const double stroke = std::min(std::max(box.travel / 100.0, 100.0 * count), 900.0 * count);
  const double sharpest = 3.0 * session.folder().document().at("limits").at("acceleration").get<double>() *
                          session.options().sheet.data.sample_period_s;
  const double slow = std::min(3.0 * stroke, sharpest);
  session.record({"reversals.csv", "reversals", {{}, {{"amplitude", stroke}, {"speed", slow}}}, "", 5.0});
  session.record(
      {"dwell.csv", "dwell", {{0.05, 0.15, 0.4, 1.0, 2.0}, {{"speed", 0.1 * top}, {"hold", 0.25}}}, "", 6.0});
  session.record(judging_jogs(session, "judge-jogs.csv"));
  session.record(judging_jogs(session, "judge-again.csv"));
  std::vector<double> levels;
  for (const double share : {0.85, 0.6, 0.45}) levels.insert(levels.end(), {-share * box.volts, share * box.volts});
  session.record({"judge-steps.csv", "steps", {levels, {{"hold", 0.35}}}, "", 6.0});
  session.disable();
  std::vector<std::string> files(kTrainingFiles.begin() + 3, kTrainingFiles.end());
  files.insert(files.end(), kJudgingFiles.begin(), kJudgingFiles.end());
  return {files, "Three motions for training, three for validation; the validation jogs were made twice."};
}

}  // namespace host
