// Faults in good records of an independent plant: in the training records, in the validation record, or in both.
#include "host/evidence/measurement_gate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string_view>

#include "host/model/model_file.hpp"
#include "host/record/read_record.hpp"
#include "host/scoreboard/simulated_null.hpp"

namespace {

using host::Record;
namespace fs = std::filesystem;

struct Case {
  sim::DriveDescription model;
  std::vector<Record> train, validate;

  explicit Case(const fs::path& folder) : model(host::read_model((folder / "model.toml").string())) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".csv") paths.push_back(entry.path());
    std::ranges::sort(paths);
    for (const fs::path& path : paths)
      (path.filename() == "validate.csv" ? validate : train).push_back(host::read_record(path.string()));
  }
};

/// Rows [begin, end).
Record cut(Record record, std::size_t begin, std::size_t end) {
  for (auto* channel : {&record.t_s, &record.u_V, &record.x, &record.w}) {
    if (channel->empty()) continue;
    channel->erase(channel->begin() + static_cast<std::ptrdiff_t>(end), channel->end());
    channel->erase(channel->begin(), channel->begin() + static_cast<std::ptrdiff_t>(begin));
  }
  return record;
}

void scale(std::vector<double>& values, double factor) {
  for (double& value : values) value *= factor;
}

void drop_rows(Record& record) {
  constexpr std::ptrdiff_t kRows = 8;
  constexpr std::size_t kSteady = 20;  // rows before and after with nearly the same travel
  std::size_t fastest = kSteady;
  double most = 0.0;
  for (std::size_t k = kSteady; k + 2 * kSteady < record.size(); ++k) {
    const double before = record.x[k] - record.x[k - kSteady], after = record.x[k + kSteady] - record.x[k];
    if (std::abs(after - before) > 0.05 * std::abs(before) || std::abs(before) < most) continue;
    most = std::abs(before);
    fastest = k;
  }
  for (auto* channel : {&record.u_V, &record.x, &record.w})
    channel->erase(channel->begin() + static_cast<std::ptrdiff_t>(fastest),
                   channel->begin() + static_cast<std::ptrdiff_t>(fastest) + kRows);
  record.t_s.resize(record.x.size());
}

struct Injection {
  const char* name;
  const char* family;  ///< name of the fault that the gate must report
  bool fatal;
  std::function<void(Record&, const sim::DataSheet&)> spoil;
};

const Injection kInjections[] = {
    {"sign", "sign", true, [](Record& r, const auto&) { scale(r.u_V, -1.0); }},
    {"speed_sign", "sign", true, [](Record& r, const auto&) { scale(r.w, -1.0); }},
    {"kilovolts", "unit", true, [](Record& r, const auto&) { scale(r.u_V, 1e-3); }},
    {"ten_times", "unit", true, [](Record& r, const auto&) { scale(r.u_V, 10.0); }},
    {"revolutions", "unit", true, [](Record& r, const auto&) { scale(r.w, 0.159155); }},
    {"swapped", "swapped", true, [](Record& r, const auto&) { std::swap(r.x, r.w); }},
    {"clipped", "clipped", true,
     [](Record& r, const auto&) {
       double top = 0.0;
       for (const double u_V : r.u_V) top = std::max(top, std::abs(u_V));
       for (double& u_V : r.u_V) u_V = std::clamp(u_V, -0.4 * top, 0.4 * top);
     }},
    {"jump", "jump", true,
     [](Record& r, const auto&) {
       for (std::size_t k = r.size() / 2; k < r.size(); ++k) r.x[k] += 17.3;
     }},
    {"gap", "gap", true, [](Record& r, const auto&) { drop_rows(r); }},
    {"scaled_copy", "scaled_copy", true,
     [](Record& r, const auto&) {
       // Three decimals, as in a log.
       for (std::size_t k = 0; k < r.size(); ++k) r.x[k] = std::round(1e6 * (3.0 * r.u_V[k] + 1.0)) / 1e6;
     }},
    {"derived", "duplicate", false,
     [](Record& r, const sim::DataSheet& data) {
       for (std::size_t k = 1; k < r.size(); ++k) r.w[k] = (r.x[k] - r.x[k - 1]) / (data.lead * r.sample_period_s);
     }},
    {"late", "time_shift", false, [](Record& r, const auto&) { std::rotate(r.w.begin(), r.w.end() - 4, r.w.end()); }},
};

/// The current of the command, logged `late` samples too late.
Record with_late_current(Record record, const sim::DataSheet& data, std::size_t late) {
  record.i_A = record.u_V;
  scale(record.i_A, data.amplifier_gain_A_per_V);
  record.u_V.clear();
  std::rotate(record.i_A.begin(), record.i_A.end() - static_cast<std::ptrdiff_t>(late), record.i_A.end());
  std::fill_n(record.i_A.begin(), late, record.i_A[late]);
  return record;
}

/// The families that the gate names; if `fatal`, only the fatal ones.
std::vector<std::string> named(const Case& spoilt, bool fatal) {
  std::vector<host::LogFault> faults;
  try {
    faults = host::MeasurementGate(spoilt.model).admit(spoilt.train, spoilt.validate).log();
  } catch (const host::FaultyLog& refused) {
    EXPECT_EQ(refused.code, host::ExitCode::bad_input);
    EXPECT_THAT(refused.what(), testing::HasSubstr("--accept"));
    faults = refused.faults;
  }
  std::vector<std::string> families;
  for (const host::LogFault& fault : faults)
    if (fault.fatal == fatal) families.emplace_back(log_fault_family(fault.kind));
  return families;
}

// A logger that filters its current logs it late in all of its records, although two of them may not show it.
TEST(LateCurrent, IsShiftedBackInAllRecordsOfItsLogger) {
  constexpr std::size_t kLate = 5;
  const Case sound(fs::path(AXIS_TEST_DATA) / "drive-cases" / "none" / "case-00");
  Case late = sound;
  for (auto* role : {&late.train, &late.validate})
    for (Record& record : *role) record = with_late_current(std::move(record), sound.model.data, kLate);
  const host::Measurements measured = host::MeasurementGate(sound.model).admit(late.train, late.validate);
  std::size_t shifted = 0;
  for (const host::LogFault& fault : measured.log()) {
    if (fault.kind != host::LogFaultKind::time_shift) continue;
    EXPECT_FALSE(fault.fatal);
    EXPECT_EQ(fault.channel, "i_A");
    EXPECT_NEAR(fault.size, 0.005, 1e-9) << fault.message;
    ++shifted;
  }
  EXPECT_EQ(shifted, sound.train.size() + sound.validate.size());
  const Record &mended = *measured.training_records().front(), &given = sound.train.front();
  ASSERT_EQ(mended.size(), given.size() - kLate);
  for (std::size_t k = 0; k < mended.size(); ++k) {
    ASSERT_NEAR(mended.i_A[k], sound.model.data.amplifier_gain_A_per_V * given.u_V[k], 1e-12) << k;
    ASSERT_EQ(mended.x[k], given.x[k]) << k;
  }
}

enum class Where { training, validation, both };

class FaultOfALog : public testing::TestWithParam<std::tuple<Injection, Where>> {};

TEST_P(FaultOfALog, IsNamedWhereverItStands) {
  const auto& [injection, where] = GetParam();
  Case spoilt(fs::path(AXIS_TEST_DATA) / "drive-cases" / "none" / "case-00");
  if (where != Where::validation)
    for (Record& record : spoilt.train) injection.spoil(record, spoilt.model.data);
  if (where != Where::training)
    for (Record& record : spoilt.validate) injection.spoil(record, spoilt.model.data);
  // A record that is clipped only rarely is found because it disagrees with the others.
  const char* other = std::string_view(injection.family) == "clipped" ? "records_disagree" : injection.family;
  EXPECT_THAT(named(spoilt, injection.fatal), testing::Contains(testing::AnyOf(injection.family, other)));
}

std::string name_of(const testing::TestParamInfo<std::tuple<Injection, Where>>& info) {
  constexpr const char* kWhere[] = {"training", "validation", "both"};
  return std::string(std::get<0>(info.param).name) + "_" + kWhere[static_cast<int>(std::get<1>(info.param))];
}

INSTANTIATE_TEST_SUITE_P(All, FaultOfALog,
                         testing::Combine(testing::ValuesIn(kInjections),
                                          testing::Values(Where::training, Where::validation, Where::both)),
                         name_of);

class Gate : public testing::Test {
 protected:
  Case sound{fs::path(AXIS_TEST_DATA) / "drive-cases" / "none" / "case-00"};
};

TEST_F(Gate, LetsSoundRecordsOfEveryShippedDrivePassInSilence) {
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(AXIS_TEST_DATA) / "drive-cases")) {
    if (entry.path().filename() != "model.toml") continue;
    const Case drive(entry.path().parent_path());
    EXPECT_THAT(named(drive, true), testing::IsEmpty()) << entry.path();
    EXPECT_THAT(named(drive, false), testing::IsEmpty()) << entry.path();
  }
}

/// Takes several minutes: every case of the shared records, and each record alone.
TEST_F(Gate, LetsSoundRecordsOfAllDrivesPassInSilence) {
  if (std::getenv("AXIS_ALL_LOG_FAULTS") == nullptr) GTEST_SKIP() << "set AXIS_ALL_LOG_FAULTS to go through all cases";
  std::size_t seen = 0;
  for (const char* set : {"drive-cases", "drive-cases-far"}) {
    const fs::path folder = fs::path(AXIS_SHARED_DIR) / "data" / set;
    if (!fs::exists(folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.path().filename() != "model.toml") continue;
      const Case drive(entry.path().parent_path());
      EXPECT_THAT(named(drive, true), testing::IsEmpty()) << entry.path();
      EXPECT_THAT(named(drive, false), testing::IsEmpty()) << entry.path();
      ++seen;
    }
  }
  if (seen == 0) GTEST_SKIP() << AXIS_SHARED_DIR << " holds no cases";
}

TEST_F(Gate, GoesOnWhereTheFaultIsAcceptedAndRemembersIt) {
  for (Record& record : sound.train) scale(record.u_V, -1.0);
  const host::MeasurementGate gate(sound.model, {.accepted = {"sign"}});
  const host::Measurements measured = gate.admit(sound.train, sound.validate);
  ASSERT_FALSE(measured.log().empty());
  for (const host::LogFault& fault : measured.log()) EXPECT_TRUE(fault.accepted) << fault.message;
}

TEST_F(Gate, RefusesToAcceptAFaultThatDoesNotExist) {
  try {
    const host::MeasurementGate gate(sound.model, {.accepted = {"signn"}});
    FAIL();
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::usage);
    EXPECT_THAT(failure.what(), testing::HasSubstr("records_disagree"));
  }
}

TEST_F(Gate, NamesARecordWhoseCommandWasScaledBetweenTheRecords) {
  scale(sound.validate.front().u_V, 1.05);
  EXPECT_THAT(named(sound, true), testing::ElementsAre("records_disagree"));
}

/// A slow record shows only friction. Its inertia is uncertain and may be wrong by the same factor by chance.
TEST(SoundRecords, OneThatTellsLittleOfTheInertiaConvictsNobody) {
  const host::SimulatedNull null = host::simulated_null(15);
  ASSERT_EQ(null.train.size(), 3U);
  EXPECT_NO_THROW(host::MeasurementGate(null.model).admit(null.train, null.validate));
}

TEST_F(Gate, NamesATachometerWhoseGainChangedBetweenTheRecords) {
  scale(sound.validate.front().w, 1.05);
  EXPECT_THAT(named(sound, true), testing::ElementsAre("records_disagree"));
}

TEST_F(Gate, LetsNothingJudgeThatTrained) {
  sound.validate = {sound.train.front()};
  EXPECT_THAT(named(sound, true), testing::ElementsAre("same_record"));
  sound.validate = {cut(sound.train.front(), 700, 3100)};
  EXPECT_THAT(named(sound, true), testing::ElementsAre("same_record"));
}

TEST_F(Gate, CountsARecordThatIsGivenTwiceOnce) {
  sound.train.push_back(sound.train.front());
  const host::Measurements measured = host::MeasurementGate(sound.model).admit(sound.train, sound.validate);
  EXPECT_EQ(measured.training().size(), sound.train.size() - 1);
  ASSERT_EQ(measured.log().size(), 1u);
  EXPECT_EQ(measured.log()[0].kind, host::LogFaultKind::same_record);
}

TEST_F(Gate, SeesNoOverlapInTheHalvesOfARecord) {
  const std::size_t half = sound.train.front().size() / 2;
  sound.train.push_back(cut(sound.train.front(), half, sound.train.front().size()));
  sound.train.front() = cut(sound.train.front(), 0, half);
  EXPECT_THAT(named(sound, true), testing::IsEmpty());
  EXPECT_THAT(named(sound, false), testing::IsEmpty());
}

TEST_F(Gate, LeavesOutASpeedThatOnlyDifferencesThePosition) {
  Record& record = sound.train.front();
  for (std::size_t k = 1; k < record.size(); ++k)
    record.w[k] = (record.x[k] - record.x[k - 1]) / (sound.model.data.lead * record.sample_period_s);
  EXPECT_FALSE(host::MeasurementGate(sound.model).admit(sound.train).training().front().has_speed());
  EXPECT_TRUE(host::MeasurementGate(sound.model, {.accepted = {}, .as_logged = true})
                  .admit(sound.train)
                  .training()[0]
                  .has_speed());
}

TEST_F(Gate, ShiftsATachometerThatRunsLateBackByWholeSamples) {
  const Record& before = sound.train.front();
  Record late = before;
  std::rotate(late.w.begin(), late.w.end() - 4, late.w.end());
  const Record after = host::MeasurementGate(sound.model).admit({late}).training().front();
  ASSERT_EQ(after.size(), before.size() - 4);
  EXPECT_EQ(after.x[100], before.x[100]);
  EXPECT_EQ(after.w[100], before.w[100]);
  EXPECT_EQ(after.t_s[100], before.t_s[100]);
}

TEST_F(Gate, SeesASignAndAUnitWithoutAModel) {
  sound.model.effects.clear();
  Case turned = sound, kilovolts = sound;
  for (Record& record : turned.train) scale(record.u_V, -1.0);
  for (Record& record : kilovolts.train) scale(record.u_V, 1e-3);
  EXPECT_THAT(named(turned, true), testing::Contains("sign"));
  EXPECT_THAT(named(kilovolts, true), testing::Contains("unit"));
}

}  // namespace
