// Faults are inserted into good records. Every command that reads records must report them and claim nothing else.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

/// The first seconds of a shipped record, as numbers: t_s, u_V, x_mm, w_rad_s.
struct Table {
  std::vector<std::array<double, 4>> rows;

  Table(const std::string& path, std::size_t most_rows) {
    std::ifstream in(path);
    for (std::string line; rows.size() < most_rows && std::getline(in, line);) {
      std::array<double, 4> row{};
      char comma = 0;
      std::istringstream cells(line);
      if (cells >> row[0] >> comma >> row[1] >> comma >> row[2] >> comma >> row[3]) rows.push_back(row);
    }
  }

  std::string text() const {
    std::string text = "# format: axis-record/1\n# sample_period_s: 0.001\nt_s,u_V,x_mm,w_rad_s\n";
    for (const auto& row : rows) text += fmt::format("{:.3f},{:.8g},{:.9g},{:.6g}\n", row[0], row[1], row[2], row[3]);
    return text;
  }
};

constexpr std::size_t u = 1, x = 2, w = 3;

struct Fault {
  const char* name;
  const char* family;
  bool fatal;
  std::function<void(Table&)> spoil;
};

void scale(Table& table, std::size_t column, double factor) {
  for (auto& row : table.rows) row[column] *= factor;
}

const Fault kFaults[] = {
    {"command_sign", "sign", true, [](Table& t) { scale(t, u, -1.0); }},
    {"speed_sign", "sign", true, [](Table& t) { scale(t, w, -1.0); }},
    {"millivolts", "unit", true, [](Table& t) { scale(t, u, 1e3); }},
    {"kilovolts", "unit", true, [](Table& t) { scale(t, u, 1e-3); }},
    {"revolutions", "unit", true, [](Table& t) { scale(t, w, 0.159155); }},
    {"swapped", "swapped", true,
     [](Table& t) {
       for (auto& row : t.rows) std::swap(row[x], row[w]);
     }},
    {"dead", "dead", true, [](Table& t) { scale(t, w, 0.0); }},
    {"jump", "jump", true,
     [](Table& t) {
       for (std::size_t k = t.rows.size() / 2; k < t.rows.size(); ++k) t.rows[k][x] += 17.3;
     }},
    {"scaled_copy", "scaled_copy", true,
     [](Table& t) {
       for (auto& row : t.rows) row[x] = std::round(1e6 * (3.0 * row[u] + 1.0)) / 1e6;
     }},
    {"derived", "duplicate", false,
     [](Table& t) {
       for (std::size_t k = 1; k < t.rows.size(); ++k)
         t.rows[k][w] = (t.rows[k][x] - t.rows[k - 1][x]) / (1.5915494309189535 * 1e-3);
     }},
    {"late", "time_shift", false,
     [](Table& t) {
       for (std::size_t k = t.rows.size(); k-- > 4;) t.rows[k][w] = t.rows[k - 4][w];
     }},
};

class FaultyLogs : public testing::TestWithParam<Fault> {
 protected:
  /// Two training records and one validation record, each with or without the fault.
  void write(bool spoils_training, bool spoils_validation) {
    constexpr std::size_t kRows = 5000;
    const auto put = [&](const char* name, bool spoilt) {
      Table table(kCase + "/" + name, kRows);
      if (spoilt) GetParam().spoil(table);
      folder.write(name, table.text());
    };
    put("train-jog.csv", spoils_training);
    put("train-steps.csv", spoils_training);
    put("validate.csv", spoils_validation);
  }

  /// Runs a command that must report the fault.
  void expect_named(const std::string& command, const std::string& output) {
    SCOPED_TRACE(command);
    const ProgramRun run = run_axistool(command + " --json -", "2>/dev/null");
    const nlohmann::json document = nlohmann::json::parse(run.output, nullptr, false);
    ASSERT_FALSE(document.is_discarded()) << run.output;
    std::vector<std::string> families;
    for (const auto& fault : document.at("log"))
      if (fault.at("fatal") == GetParam().fatal) families.push_back(fault.at("fault"));
    EXPECT_THAT(families, testing::Contains(GetParam().family));
    if (document.contains("verdict")) {
      EXPECT_EQ(document["verdict"].at("effects").size(), 0U);
    }
    if (!GetParam().fatal) return;
    EXPECT_EQ(run.exit_code, 9);
    EXPECT_FALSE(document.contains("verdict"));
    if (!output.empty()) {
      EXPECT_FALSE(std::filesystem::exists(folder.path(output)));
    }
  }

  std::string file(const char* name) const { return fmt::format("'{}'", folder.path(name)); }

  TemporaryFolder folder;
  const std::string model = fmt::format("'{}/model.toml'", kCase);
};

TEST_P(FaultyLogs, AreNamedByWhatReadsRecordsAlone) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  write(true, true);
  expect_named(fmt::format("identify {} --drive {} -o {}", file("train-steps.csv"), model, file("out.toml")),
               "out.toml");
  expect_named(fmt::format("friction {} --model {} -o {}", file("train-jog.csv"), model, file("out.toml")), "out.toml");
  expect_named(fmt::format("compare {} {}", model, file("validate.csv")), "");
}

TEST_P(FaultyLogs, AreNamedByWhatTrainsAndJudges) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  for (const bool in_training : {true, false}) {
    SCOPED_TRACE(in_training ? "training" : "validation");
    write(in_training, !in_training);
    const std::string records = fmt::format("{} --train {} {} --validate {}", model, file("train-jog.csv"),
                                            file("train-steps.csv"), file("validate.csv"));
    expect_named("diagnose " + records, "");
    if (!GetParam().fatal) continue;  // improve and add continue with the same search
    expect_named("improve " + records + " -o " + file("out.toml"), "out.toml");
    expect_named(fmt::format("add {} cogging --train {} {} --validate {} -o {}", model, file("train-jog.csv"),
                             file("train-steps.csv"), file("validate.csv"), file("out.toml")),
                 "out.toml");
  }
}

std::string name_of_fault(const testing::TestParamInfo<Fault>& fault) { return fault.param.name; }

INSTANTIATE_TEST_SUITE_P(Every, FaultyLogs, testing::ValuesIn(kFaults), name_of_fault);

}  // namespace
