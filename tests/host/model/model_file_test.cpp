// Model files: contents of valid ones, messages about invalid ones, and writing without loss.
#include "host/model/model_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "host/exit_codes.hpp"
#include "host/known_by_current.hpp"
#include "sim/catalogue.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// The x axis of the paper (Table 1). Line numbers below count from its first line.
constexpr const char* kPaperX = R"(format = "axis-model/1"
name = "x"

[drive]
kind = "rotary"
amplifier_gain_A_per_V = 6.4898
torque_constant_Nm_per_A = 0.4769
lead_mm_per_rad = 1.5915494309189535
sample_period_s = 0.001
[drive.dac]
resolution_V = 0.00030517578125
limit_V = 10
[drive.encoder]
resolution_mm = 0.00244140625
[drive.tach]
noise_variance_rad2_s2 = 0.05

[[effect]]
kind = "inertia"
J_kg_m2 = 0.00765
J_kg_m2_ci95 = [0.0076, 0.0077]
from = "steps.csv"
[[effect]]
kind = "viscous"
B_Nm_s_per_rad = 0.0296
[[effect]]
kind = "coulomb"
positive_Nm = 2.205
negative_Nm = -1.656
[[effect]]
kind = "stribeck"
static_positive_Nm = 3.647
static_negative_Nm = -2.702
omega1_positive_rad_s = 2.0
omega1_negative_rad_s = -2.0
omega2_rad_s = 2.0
)";

constexpr const char* kLinear = R"(format = "axis-model/1"
[drive]
kind = "linear"
force_constant_N_per_V = 35.1507
sample_period_s = 0.001
[drive.encoder]
resolution_mm = 5e-5
[[effect]]
kind = "inertia"
M_kg = 95.1
[[effect]]
kind = "coulomb"
level_N = 20.4
)";

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

std::string message_of(const std::string& text) {
  try {
    host::parse_model(text, "drive.toml");
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
    EXPECT_THAT(failure.what(), HasSubstr("drive.toml: line "));
    return failure.what();
  }
  return "no failure";
}

std::string message_of(std::string_view what, std::string_view by) { return message_of(replaced(kPaperX, what, by)); }

TEST(ReadModel, RotaryDriveOfThePaper) {
  const sim::DriveDescription model = host::parse_model(kPaperX, "drive.toml");
  EXPECT_EQ(model.name, "x");
  EXPECT_EQ(model.data.kind, sim::DriveKind::rotary);
  EXPECT_EQ(model.data.amplifier_gain_A_per_V, 6.4898);
  EXPECT_EQ(model.data.torque_constant_Nm_per_A, 0.4769);
  EXPECT_EQ(model.data.lead, 1.5915494309189535);
  EXPECT_EQ(model.data.sample_period_s, 0.001);
  EXPECT_EQ(model.data.dac_resolution_V, 0.00030517578125);
  EXPECT_EQ(model.data.dac_limit_V, 10.0);
  EXPECT_EQ(model.data.encoder_resolution, 0.00244140625);
  EXPECT_EQ(model.data.tach_noise_variance, 0.05);
  ASSERT_EQ(model.effects.size(), 4u);
  EXPECT_EQ(model.effects[0].at("J"), 0.00765);
  EXPECT_EQ(model.effects[0].ci95.at("J"), (std::array{0.0076, 0.0077}));
  EXPECT_EQ(model.effects[0].from, "steps.csv");
  EXPECT_EQ(model.effects[2].at("negative"), -1.656);
  EXPECT_EQ(model.effects[3].kind, "stribeck");
  EXPECT_EQ(model.effects[3].at("omega1_negative"), -2.0);
  EXPECT_EQ(model.effects[3].at("omega2"), 2.0);
}

TEST(ReadModel, LinearDriveInMetres) {
  const sim::DriveDescription model = host::parse_model(kLinear, "drive.toml");
  EXPECT_EQ(model.data.kind, sim::DriveKind::linear);
  EXPECT_EQ(model.data.force_constant_N_per_V, 35.1507);
  EXPECT_EQ(model.data.lead, 1.0);
  EXPECT_DOUBLE_EQ(model.data.encoder_resolution, 5e-8);
  EXPECT_FALSE(model.data.tach_noise_variance.has_value());
  EXPECT_EQ(model.find("inertia")->at("J"), 95.1);
  EXPECT_EQ(model.find("coulomb")->at("level"), 20.4);
}

TEST(ReadModel, AScaleOnTheTable) {
  const std::string scale =
      "[drive.load_encoder]\nresolution_mm = 0.0005\ncyclic_error_mm = 0.001\ncyclic_period_mm = 0.02\n"
      "cyclic_phase_rad = 0.5\noffset_mm_per_K = 0.003\n";
  const sim::DriveDescription model =
      host::parse_model(replaced(kPaperX, "[drive.tach]", scale + "[drive.tach]"), "drive.toml");
  EXPECT_TRUE(model.data.has_load_encoder());
  EXPECT_EQ(model.data.load_encoder_resolution, 0.0005);
  EXPECT_NEAR(model.data.load_encoder_error(0.02 * 0.5 / 6.283185307), 0.001, 1e-9) << "largest at its phase";
  EXPECT_NEAR(model.data.load_encoder_error(0.02 * 0.5 / 6.283185307, 2.0), 0.007, 1e-9) << "and warmer by 2 K";
  const sim::DriveDescription again = host::parse_model(host::format_model(model), "again.toml");
  EXPECT_EQ(again.data.load_encoder_cyclic_error, 0.001);
  EXPECT_EQ(again.data.load_encoder_cyclic_period, 0.02);
  EXPECT_EQ(again.data.load_encoder_cyclic_phase_rad, 0.5);
  EXPECT_EQ(again.data.load_encoder_offset_per_K, 0.003);
  const sim::DriveDescription linear = host::parse_model(
      replaced(kLinear, "[[effect]]", "[drive.load_encoder]\nresolution_mm = 0.0005\ncyclic_phase_rad = 0\n[[effect]]"),
      "drive.toml");
  EXPECT_DOUBLE_EQ(linear.data.load_encoder_resolution, 5e-7);
}

TEST(ReadModel, AScaleWithoutWhatItNeeds) {
  const auto with = [](const std::string& fields) {
    return message_of("[drive.tach]", "[drive.load_encoder]\n" + fields + "[drive.tach]");
  };
  EXPECT_THAT(with("cyclic_error_mm = 0.001\ncyclic_period_mm = 0.02\n"),
              AllOf(HasSubstr("line 15"), HasSubstr("missing field resolution_mm in [drive.load_encoder]")));
  EXPECT_THAT(with("resolution_mm = 0.001\ncyclic_error_mm = 0.001\n"), HasSubstr("go together"));
  EXPECT_THAT(with("resolution_mm = 0\n"), HasSubstr("out of bounds"));
  EXPECT_THAT(with("resolution_m = 0.001\n"), AllOf(HasSubstr("resolution_m"), HasSubstr("[drive.load_encoder]")));
}

TEST(ReadModel, DataSheetAloneServesIdentification) {
  const std::string text = std::string(kPaperX).substr(0, std::string(kPaperX).find("[[effect]]"));
  EXPECT_TRUE(host::parse_drive(text, "drive.toml").effects.empty());
  EXPECT_THAT(message_of(text), AllOf(HasSubstr("no [[effect]]"), HasSubstr("identify")));
}

TEST(ReadModel, SeveralHarmonicsButOneInertia) {
  const std::string cogging = "[[effect]]\nkind = \"cogging\"\ncosine_Nm = 0.1\nsine_Nm = 0.0\nperiod_mm = 2.5\n";
  EXPECT_EQ(host::parse_model(kPaperX + cogging + cogging, "drive.toml").effects.size(), 6u);
  EXPECT_THAT(message_of(std::string(kPaperX) + "[[effect]]\nkind = \"inertia\"\nJ_kg_m2 = 1.0\n"),
              AllOf(HasSubstr("line 37"), HasSubstr("inertia is in the model twice")));
}

/// The destruction of a tree with 50,000 levels exhausts the stack, so such keys are rejected before it is built.
TEST(ReadModel, KeysOfEndlesslyManyParts) {
  std::string key = "a", quoted = "'a'";
  for (int k = 0; k < 50'000; ++k) key += ".a", quoted += " . 'a'";
  for (const std::string& line : {key + " = 1", "[" + key + "]", "[[" + quoted + "]]", "a = { " + key + " = 1 }"})
    EXPECT_THAT(message_of("name = \"x\"", line), AllOf(HasSubstr("line 2"), HasSubstr("parts")));
}

TEST(ReadModel, DotsInTextsAndNumbersAreNoKeys) {
  const std::string dots(100, '.');
  const std::string text = replaced(kPaperX, "name = \"x\"", "name = \"" + dots + "\"  # " + dots);
  EXPECT_EQ(host::parse_model(text, "drive.toml").name, dots);
}

TEST(ReadModel, AnIntervalHoldsItsValue) {
  EXPECT_THAT(message_of("[0.0076, 0.0077]", "[0.0077, 0.0078]"),
              AllOf(HasSubstr("line 21"), HasSubstr("does not hold the value 0.00765")));
}

TEST(ReadModel, NotToml) {
  EXPECT_THAT(message_of("name = \"x\"", "name = x"), AllOf(HasSubstr("line 2"), HasSubstr("not valid TOML")));
}

TEST(ReadModel, UnknownFormat) {
  EXPECT_THAT(message_of("axis-model/1", "axis-model/2"),
              AllOf(HasSubstr("line 1"), HasSubstr("axis-model/2"), HasSubstr("reads axis-model/1")));
  EXPECT_THAT(message_of("format = \"axis-model/1\"", ""), HasSubstr("missing field format"));
}

TEST(ReadModel, UnknownFieldsSuggestTheNearest) {
  EXPECT_THAT(message_of("J_kg_m2 =", "J_kgm2 ="),
              AllOf(HasSubstr("line 20"), HasSubstr("J_kgm2"), HasSubstr("did you mean J_kg_m2?")));
  EXPECT_THAT(message_of("lead_mm_per_rad", "lead_mm_rad"),
              AllOf(HasSubstr("line 8"), HasSubstr("in [drive]"), HasSubstr("did you mean lead_mm_per_rad?")));
  EXPECT_THAT(message_of("limit_V", "limits_V"), AllOf(HasSubstr("line 12"), HasSubstr("did you mean limit_V?")));
  EXPECT_THAT(message_of("[drive.tach]", "[drive.tacho]"), AllOf(HasSubstr("line 15"), HasSubstr("tach?")));
  EXPECT_THAT(message_of("name =", "colour ="), AllOf(HasSubstr("line 2"), HasSubstr("known: format, name")));
}

TEST(ReadModel, UnknownEffect) {
  EXPECT_THAT(message_of("\"stribeck\"", "\"stribek\""),
              AllOf(HasSubstr("line 31"), HasSubstr("'stribek' is unknown"), HasSubstr("did you mean stribeck?")));
}

TEST(ReadModel, MissingFields) {
  EXPECT_THAT(
      message_of("lead_mm_per_rad = 1.5915494309189535\n", ""),
      AllOf(HasSubstr("line 4"), HasSubstr("missing field in [drive]: lead_mm_per_rad"), HasSubstr("data sheet")));
  EXPECT_THAT(message_of("B_Nm_s_per_rad = 0.0296\n", ""),
              AllOf(HasSubstr("line 23"), HasSubstr("missing field B_Nm_s_per_rad in effect viscous")));
  EXPECT_THAT(message_of("kind = \"viscous\"\n", ""), AllOf(HasSubstr("line 23"), HasSubstr("missing field kind")));
  EXPECT_THAT(message_of("kind = \"inertia\"\nJ_kg_m2 = 0.00765\nJ_kg_m2_ci95 = [0.0076, 0.0077]",
                         "kind = \"dac_offset\"\noffset_V = 0.01"),
              HasSubstr("missing effect inertia"));
}

/// Catches a reader that names only one missing field at a time.
TEST(ReadModel, NamesAllThatADataSheetLacks) {
  const std::string head = "format = \"axis-model/1\"\n[drive]\n";
  EXPECT_THAT(message_of(head + "kind = \"rotary\"\n[drive.tach]\n"),
              AllOf(HasSubstr("torque_constant_Nm_per_A"), HasSubstr("lead_mm_per_rad"), HasSubstr("sample_period_s"),
                    HasSubstr("noise_variance_rad2_s2")));
  EXPECT_THAT(
      message_of(head + "kind = \"linear\"\n"),
      AllOf(HasSubstr("force_constant_N_per_V"), HasSubstr("force_constant_N_per_A"), HasSubstr("sample_period_s")));
  EXPECT_THAT(message_of(head + "force_constant_N_per_A = 3\n"),
              AllOf(HasSubstr("kind = "), HasSubstr("sample_period_s"), Not(HasSubstr("lead"))));
}

/// A log of the current needs no amplifier gain: a data sheet without one stays without one.
TEST(ReadModel, TorqueOrForceOfTheCurrentAlone) {
  const std::string common = "format = \"axis-model/1\"\nname = \"k\"\n[drive]\nsample_period_s = 0.001\n";
  for (const std::string& sheet :
       {common + "kind = \"rotary\"\ntorque_constant_Nm_per_A = 0.4\nlead_mm_per_rad = 1.5\n",
        common + "kind = \"linear\"\nforce_constant_N_per_A = 40\n"}) {
    const sim::DriveDescription drive = host::parse_drive(sheet, "drive.toml");
    EXPECT_TRUE(host::is_known_by_current(drive.data));
    EXPECT_EQ(drive.data.effort_per_volt(), drive.data.torque_constant_Nm_per_A);
    EXPECT_THROW(host::require_volts(drive.data, "k", "a board"), host::Failure);
    const std::string written = host::format_model(drive);
    for (const char* of_volts : {"amplifier_gain", "N_per_V", "[drive.dac]"})
      EXPECT_THAT(written, Not(HasSubstr(of_volts)));
    EXPECT_TRUE(host::is_known_by_current(host::parse_drive(written, "again.toml").data));
    EXPECT_THAT(message_of(sheet + "[drive.dac]\nlimit_V = 10\n"), HasSubstr("[drive.dac] is about volts"));
  }
  EXPECT_FALSE(host::is_known_by_current(host::parse_model(kPaperX, "x.toml").data));
}

/// Catches a model that takes minutes of computation.
TEST(ReadModel, HoldsNoMoreThanAModelDoes) {
  std::string many = kPaperX, list, knots;
  for (int k = 0; k < 62; ++k)
    many += "[[effect]]\nkind = \"cogging\"\nperiod_mm = 5\ncosine_Nm = 0.1\nsine_Nm = 0.1\n";
  EXPECT_THAT(message_of(many), HasSubstr("a model may have at most 64"));
  for (int k = 1; k <= 129; ++k) list += "{ order = " + std::to_string(k) + ", cosine_Nm = 1e-4, sine_Nm = 1e-4 },";
  EXPECT_THAT(message_of(kPaperX + ("[[effect]]\nkind = \"cogging\"\nperiod_mm = 5\nharmonics = [" + list + "]\n")),
              HasSubstr("an effect may have at most 128"));
  for (int k = 0; k <= 1000; ++k) knots += std::to_string(k) + ",";
  EXPECT_THAT(message_of(kPaperX + ("[[effect]]\nkind = \"free_curve\"\nover = \"speed\"\nknots = [" + knots +
                                    "]\nvalues_Nm = [" + knots + "]\n")),
              HasSubstr("a curve may have at most 1000"));
}

TEST(ReadModel, OneFormForBothDirectionsOrOneForEach) {
  EXPECT_THAT(message_of("negative_Nm = -1.656\n", ""),
              AllOf(HasSubstr("missing field negative_Nm"), HasSubstr("level_Nm for both directions")));
  EXPECT_THAT(
      message_of("negative_Nm = -1.656\n", "level_Nm = 2.0\n"),
      AllOf(HasSubstr("level_Nm is given together with a value for one direction"), HasSubstr("keep one form")));
}

TEST(ReadModel, WrongTypes) {
  EXPECT_THAT(message_of("0.00765", "\"0.00765\""),
              AllOf(HasSubstr("line 20"), HasSubstr("J_kg_m2: expected a number")));
  EXPECT_THAT(message_of("0.00765", "nan"), AllOf(HasSubstr("line 20"), HasSubstr("finite")));
  EXPECT_THAT(message_of("\"rotary\"", "1"), AllOf(HasSubstr("line 5"), HasSubstr("kind: expected a text in quotes")));
  EXPECT_THAT(message_of("\"rotary\"", "\"round\""),
              AllOf(HasSubstr("line 5"), HasSubstr("rotary"), HasSubstr("linear")));
  EXPECT_THAT(message_of("[0.0076, 0.0077]", "0.0076"), AllOf(HasSubstr("line 21"), HasSubstr("[low, high]")));
  EXPECT_THAT(message_of("[0.0076, 0.0077]", "[0.0078, 0.0077]"), AllOf(HasSubstr("line 21"), HasSubstr("swap")));
}

TEST(ReadModel, ValuesOutOfPhysicalBounds) {
  EXPECT_THAT(message_of("= 0.4769", "= -0.4769"), AllOf(HasSubstr("line 7"), HasSubstr("-0.4769 is out of bounds")));
  EXPECT_THAT(message_of("J_kg_m2 = 0.00765", "J_kg_m2 = 0"), AllOf(HasSubstr("line 20"), HasSubstr("out of bounds")));
  EXPECT_THAT(message_of("-1.656", "1.656"),
              AllOf(HasSubstr("negative_Nm: 1.656 is out of bounds"), HasSubstr("backward, negative")));
  EXPECT_THAT(message_of("omega1_negative_rad_s = -2.0", "omega1_negative_rad_s = 2.0"), HasSubstr("out of bounds"));
}

TEST(ReadModel, FieldsOfTheOtherKindOfDrive) {
  EXPECT_THAT(message_of("lead_mm_per_rad = 1.5915494309189535", "force_constant_N_per_V = 3"),
              AllOf(HasSubstr("line 8"), HasSubstr("force_constant_N_per_V belongs to a linear drive")));
  EXPECT_THAT(message_of("J_kg_m2 = 0.00765", "M_kg = 0.00765"),
              AllOf(HasSubstr("line 20"), HasSubstr("M_kg belongs to a linear drive"), HasSubstr("give J_kg_m2")));
  EXPECT_THAT(message_of(replaced(kLinear, "sample_period_s = 0.001", "sample_period_s = 0.001\nlead_mm_per_rad = 1")),
              AllOf(HasSubstr("line 6"), HasSubstr("lead_mm_per_rad belongs to a rotary drive")));
}

void expect_same(const sim::DriveDescription& a, const sim::DriveDescription& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.data.kind, b.data.kind);
  EXPECT_EQ(a.data.effort_per_volt(), b.data.effort_per_volt());
  EXPECT_EQ(a.data.lead, b.data.lead);
  EXPECT_EQ(a.data.sample_period_s, b.data.sample_period_s);
  EXPECT_EQ(a.data.dac_resolution_V, b.data.dac_resolution_V);
  EXPECT_EQ(a.data.dac_limit_V, b.data.dac_limit_V);
  EXPECT_EQ(a.data.encoder_resolution, b.data.encoder_resolution);
  EXPECT_EQ(a.data.tach_noise_variance, b.data.tach_noise_variance);
  ASSERT_EQ(a.effects.size(), b.effects.size());
  for (std::size_t k = 0; k < a.effects.size(); ++k) {
    EXPECT_EQ(a.effects[k].kind, b.effects[k].kind);
    EXPECT_EQ(a.effects[k].parameters, b.effects[k].parameters);
    EXPECT_EQ(a.effects[k].ci95, b.effects[k].ci95);
    EXPECT_EQ(a.effects[k].from, b.effects[k].from);
  }
}

TEST(WriteModel, ReadsBackTheSame) {
  const TemporaryFolder folder;
  for (const char* text : {kPaperX, kLinear}) {
    sim::DriveDescription model = host::parse_model(text, "drive.toml");
    model.effects[0].parameters["J"] = std::nextafter(0.023, 1.0) / 3.0;  // within its interval
    model.effects[0].from = "C:\\logs\\\"run\"\n2.csv";
    const std::string path = folder.path("model.toml");
    host::write_model(model, path);
    expect_same(model, host::read_model(path));
  }
}

TEST(WriteModel, EveryEffectOfTheCatalogueBothKinds) {
  for (const sim::DriveKind kind : {sim::DriveKind::rotary, sim::DriveKind::linear}) {
    sim::DriveDescription model = host::parse_model(kind == sim::DriveKind::rotary ? kPaperX : kLinear, "drive.toml");
    for (const sim::EffectInfo* info : sim::catalogue()) {
      if (model.find(info->kind) != nullptr || info->curve) continue;
      sim::EffectEntry entry{std::string(info->kind), {}, {}, "r.csv"};
      for (const sim::ParameterInfo& parameter : info->parameters) {
        if (!parameter.pair_of.empty() || parameter.id == "saturation") continue;  // has another form
        const double value = parameter.lower + (parameter.upper - parameter.lower) / 3.0;
        entry.parameters[std::string(parameter.id)] = value;
        entry.ci95[std::string(parameter.id)] = {value - 1.0, value + 1.0};
      }
      model.effects.push_back(entry);
    }
    expect_same(model, host::parse_model(host::format_model(model), "drive.toml"));
  }
}

constexpr const char* kSeveralOrders = R"([[effect]]
kind = "cogging"
period_mm = 10.0
harmonics = [
  { order = 1, cosine_Nm = 0.1, sine_Nm = -0.2 },
  { order = 6, cosine_Nm = 0.03, sine_Nm = 0.04, sine_Nm_ci95 = [0.03, 0.05] },
]
)";

// Catches an order that is written under the id of another order, or is lost.
TEST(WriteModel, KeepsTheOrdersOfAPeriod) {
  const sim::DriveDescription model = host::parse_model(std::string(kPaperX) + kSeveralOrders, "drive.toml");
  const sim::EffectEntry& cogging = *model.find("cogging");
  EXPECT_EQ(cogging.at("cosine"), 0.1);
  EXPECT_EQ(cogging.at("sine_6"), 0.04);
  EXPECT_EQ(cogging.ci95.at("sine_6"), (std::array{0.03, 0.05}));
  expect_same(model, host::parse_model(host::format_model(model), "again.toml"));
  EXPECT_THAT(host::format_model(model), HasSubstr("{ order = 6, cosine_Nm = 0.03, sine_Nm = 0.04"));
}

TEST(ReadModel, OrdersInOneFormAndOnce) {
  const std::string text = std::string(kPaperX) + kSeveralOrders;
  EXPECT_THAT(message_of(replaced(text, "period_mm", "cosine_Nm = 1.0\nperiod_mm")), HasSubstr("keep one form"));
  EXPECT_THAT(message_of(replaced(text, "order = 6", "order = 1")), HasSubstr("order 1 is given twice"));
  EXPECT_THAT(message_of(replaced(text, "{ order = 6,", "{")), HasSubstr("order = 1"));
  EXPECT_THAT(message_of(replaced(text, "order = 6, cosine_Nm", "order = 6, cosine_mm")), HasSubstr("cosine_mm"));
}

TEST(WriteModel, KeepsWhatIsKnownOfAParameter) {
  const std::string text = replaced(replaced(kPaperX, "J_kg_m2 = 0.00765", "J_kg_m2 = 0.00765\nJ_kg_m2_held = true"),
                                    "B_Nm_s_per_rad = 0.0296", "B_Nm_s_per_rad = 0.0296\nB_Nm_s_per_rad_sd = 0.003");
  const sim::DriveDescription model = host::parse_model(text, "drive.toml");
  EXPECT_TRUE(model.find("inertia")->held.contains("J"));
  EXPECT_EQ(model.find("viscous")->believed.at("B"), (sim::Belief{0.0296, 0.003}));
  const sim::DriveDescription again = host::parse_model(host::format_model(model), "again.toml");
  EXPECT_EQ(again.find("inertia")->held, model.find("inertia")->held);
  EXPECT_EQ(again.find("viscous")->believed, model.find("viscous")->believed);
  sim::DriveDescription fitted = model;
  fitted.find("viscous")->parameters["B"] = 0.031;
  const sim::DriveDescription moved = host::parse_model(host::format_model(fitted), "moved.toml");
  EXPECT_EQ(moved.find("viscous")->at("B"), 0.031);
  EXPECT_EQ(moved.find("viscous")->believed, model.find("viscous")->believed) << "a fit is no data sheet";
  EXPECT_THAT(message_of("B_Nm_s_per_rad = 0.0296", "B_Nm_s_per_rad_sd = 0.003\nB_Nm_s_per_rad = 0.0296"),
              testing::Eq("no failure"));
  EXPECT_THAT(message_of("B_Nm_s_per_rad = 0.0296", "B_Nm_s_per_rad_held = true"), HasSubstr("is given without"));
}

constexpr const char* kCurve = R"([[effect]]
kind = "free_curve"
over = "speed"
knots = [-10.0, 0.0, 10.0]
values_Nm = [-0.2, 0.0, 0.1]
sd_Nm = [0.01, 0.02, 0.01]
)";

TEST(WriteModel, KeepsACurve) {
  const sim::DriveDescription model = host::parse_model(std::string(kPaperX) + kCurve, "drive.toml");
  const sim::EffectEntry& curve = *model.find("free_curve");
  EXPECT_EQ(curve.over, "speed");
  EXPECT_EQ(curve.at("knot_2"), 10.0);
  EXPECT_EQ(curve.at("value_0"), -0.2);
  const sim::DriveDescription again = host::parse_model(host::format_model(model), "again.toml");
  EXPECT_EQ(again.find("free_curve")->parameters, curve.parameters);
  EXPECT_EQ(again.find("free_curve")->over, "speed");
  EXPECT_NEAR(again.find("free_curve")->ci95.at("value_1")[1], 0.02 * 1.96, 1e-12);
}

TEST(ReadModel, ACurveThatIsNone) {
  const std::string text = std::string(kPaperX) + kCurve;
  EXPECT_THAT(message_of(replaced(text, "\"speed\"", "\"weather\"")), HasSubstr("position"));
  EXPECT_THAT(message_of(replaced(text, "[-10.0, 0.0, 10.0]", "[-10.0, 10.0, 0.0]")), HasSubstr("above"));
  EXPECT_THAT(message_of(replaced(text, "[-10.0, 0.0, 10.0]", "[-10.0, 10.0]")), HasSubstr("same length"));
  EXPECT_THAT(message_of(replaced(text, "\"speed\"", "\"phase\"")), HasSubstr("must equal the first"));
}

TEST(WriteModel, WritesNumbersAsPeopleDo) {
  const std::string text = host::format_model(host::parse_model(kPaperX, "drive.toml"));
  EXPECT_THAT(text, AllOf(HasSubstr("J_kg_m2 = 0.00765\nJ_kg_m2_ci95 = [0.0076, 0.0077]\n"),
                          HasSubstr("resolution_V = 0.00030517578125\nlimit_V = 10.0\n"),
                          HasSubstr("negative_Nm = -1.656\n"), HasSubstr("from = \"steps.csv\"\n")));
}

TEST(WriteModel, LeavesOutAnIntervalOfAnotherValue) {
  sim::DriveDescription model = host::parse_model(kPaperX, "drive.toml");
  model.find("inertia")->parameters["J"] = 0.009;
  EXPECT_TRUE(host::parse_model(host::format_model(model), "again").find("inertia")->ci95.empty());
}

TEST(WriteModel, RefusesAFailedFit) {
  sim::DriveDescription model = host::parse_model(kPaperX, "drive.toml");
  model.effects[0].parameters["J"] = std::nan("");
  EXPECT_THROW(host::format_model(model), host::Failure);
}

TEST(ReadModel, ModelsOfTheDriveCases) {
  const std::filesystem::path cases = std::filesystem::path(AXIS_SHARED_DIR) / "data" / "drive-cases";
  if (!std::filesystem::exists(cases)) GTEST_SKIP() << "no models in " << cases;
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(cases)) {
    if (entry.path().filename() != "model.toml") continue;
    sim::DriveDescription model;
    ASSERT_NO_THROW(model = host::read_model(entry.path().string())) << entry.path();
    expect_same(model, host::parse_model(host::format_model(model), "again.toml"));
    ++count;
  }
  EXPECT_GT(count, 0);
}

}  // namespace
