// The error of one model on one record is the same in every command.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>

#include "host/compare/comparison_figures.hpp"
#include "host/diagnose/diagnosis_json.hpp"
#include "tests/host/diagnose/drive_case.hpp"

namespace {

using nlohmann::json;

json compared(const sim::DriveDescription& model, const std::vector<host::Record>& records) {
  return host::comparison_json(host::compare_with("model", model, records, host::kWindow_s, {}).comparison);
}

/// Error figures of all records together, with all digits.
void expect_same(const json& told, const sim::DriveDescription& model, const std::vector<host::Record>& records,
                 const std::string& where) {
  const json by_compare = compared(model, records);
  EXPECT_EQ(told, by_compare["error"]) << where;
  EXPECT_EQ(told["combined"], by_compare["combined"]) << where;
  for (const auto& [name, channel] : by_compare["channels"].items()) {
    EXPECT_EQ(told["channels"][name]["rms"], channel["rms"]) << where << ' ' << name;
    EXPECT_EQ(told["channels"][name]["floor"], channel["floor"]) << where << ' ' << name;
  }
}

struct Asked {
  const char* name;
  bool swapped;  ///< the validation record is used for training, and the others for validation
};

class OneMeasure : public testing::TestWithParam<Asked> {};

/// Catches noise floors of another model, other windows, other sensors and the smoother of another model. Each of these
/// made compare, ladder and sentence differ by a tenth or by a factor of ten.
TEST_P(OneMeasure, CommandsAgreeToTheDigit) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  DriveCase asked(GetParam().name);
  if (GetParam().swapped) std::swap(asked.train, asked.validate);
  const host::Measurements measured = host::MeasurementGate(asked.model).admit(asked.train, asked.validate);
  ASSERT_EQ(measured.training().size(), asked.train.size());
  const host::Improvement improvement = host::improve(asked.model, measured, {}, {}, {}, 1);
  const host::Diagnosis& diagnosis = improvement.first;
  const json diagnosed = host::to_json(diagnosis)["error"], improved = host::to_json(improvement, "");
  sim::DriveDescription base = diagnosis.base, best = diagnosis.best;
  base.data = best.data = asked.model.data;
  for (const auto& [set, records] : {std::pair("train", &asked.train), std::pair("validate", &asked.validate)}) {
    expect_same(diagnosed["given"][set], asked.model, *records, "diagnose, as given");
    expect_same(diagnosed["before"][set], base, *records, "diagnose, before");
    expect_same(diagnosed["after"][set], best, *records, "diagnose, after");
    expect_same(improved["error"]["given"][set], asked.model, *records, "improve, as given");
    expect_same(improved["ladder"].front()["error"][set], base, *records, "improve, first step");
    expect_same(improved["error"]["after"][set], improvement.model, *records, "improve, its model");
    if (!diagnosis.judged_as_compared()) continue;
    EXPECT_EQ(diagnosed["combined"]["before"][set], diagnosed["before"][set]["combined"]);
    EXPECT_EQ(diagnosed["combined"]["after"][set], diagnosed["after"][set]["combined"]);
    EXPECT_EQ(improved["ladder"].front()[set], diagnosed["before"][set]["combined"]);
  }
  if (diagnosis.judged_as_compared())
    for (const host::JudgedCandidate& candidate :
         std::span(diagnosis.candidates).first(std::min<std::size_t>(1, diagnosis.candidates.size()))) {
      sim::DriveDescription model = candidate.model;
      model.data = asked.model.data;
      EXPECT_EQ(host::Diagnosis::printed(candidate).train, compared(model, asked.train)["combined"]);
      EXPECT_EQ(host::Diagnosis::printed(candidate).validate, compared(model, asked.validate)["combined"]);
    }
  const double given = improved["error"]["given"]["validate"]["combined"];
  EXPECT_LE(improved["error"]["after"]["validate"]["combined"].get<double>(), given * (1.0 + 1e-9));
}

INSTANTIATE_TEST_SUITE_P(Cases, OneMeasure,
                         testing::Values(Asked{"none/case-00", false}, Asked{"none/case-01", false},
                                         Asked{"none/case-01", true}, Asked{"pairs/case-00", false},
                                         Asked{"single/case-00", false}, Asked{"single/case-06", false},
                                         Asked{"single/case-09", false}, Asked{"single/case-13", false},
                                         Asked{"single/case-17", false}, Asked{"single/case-19", false}));

}  // namespace
