// The page asks for pictures of records: what is wrong is refused by name, and a changed file is read again.
#include "host/workbench/record_pictures.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "host/exit_codes.hpp"
#include "host/record/read_record.hpp"
#include "host/workbench/actions.hpp"
#include "tests/host/workbench/served_folder.hpp"

namespace {

using nlohmann::json;

/// A record of one channel at 1 kHz, with a spike at a row.
std::string record_with_spike(std::size_t rows, std::size_t spike) {
  std::string text = "# format: axis-record/1\nt_s,u_V,x_mm\n";
  for (std::size_t row = 0; row < rows; ++row)
    text += fmt::format("{:.3f},{},{}\n", 0.001 * static_cast<double>(row),
                        row == spike ? 9.5 : 0.001 * static_cast<double>(row % 10), row % 13);
  return text;
}

json whole(const std::string& record, std::size_t pixels = 100) {
  return {{"record", record}, {"from", 0}, {"to", 1'000'000'000}, {"pixels", pixels}};
}

/// The answer once the whole file has been read.
json read_answer(const ServedFolder& served, const json& request) {
  for (int tries = 0; tries < 1000; ++tries) {
    const auto [status, told] = served.post("/api/record", request);
    if (status != 200 || told["share"] == 1.0) return told;
  }
  return nullptr;
}

/// Row of the highest value of a channel.
std::size_t highest_row(const json& told, const std::string& channel) {
  const auto place = static_cast<std::size_t>(std::find(told["channels"].begin(), told["channels"].end(), channel) -
                                              told["channels"].begin());
  const json& values = told.contains("high") ? told["high"][place] : told["low"][place];
  const auto highest = std::max_element(values.begin(), values.end());
  return told["first"].get<std::size_t>() +
         static_cast<std::size_t>(highest - values.begin()) * told["rows"].get<std::size_t>();
}

TEST(RecordPictures, LeadFromTheWholeRecordToTheRowOfASpike) {
  const ServedFolder served;
  served.folder.write("long.csv", record_with_spike(50'000, 31'234));
  json told = read_answer(served, whole("long.csv"));
  EXPECT_EQ(told["end"], 50'000);
  EXPECT_EQ(told["channels"], json({"u_V", "x_mm"}));
  EXPECT_LE(told["taken"].size(), 102U);
  std::size_t at = highest_row(told, "u_V"), rows = told["rows"];
  while (rows > 1) {
    told = read_answer(
        served, {{"record", "long.csv"}, {"channels", {"u_V"}}, {"from", at}, {"to", at + rows}, {"pixels", 20}});
    ASSERT_LT(told["rows"], rows) << told;
    at = highest_row(told, "u_V");
    rows = told["rows"];
  }
  EXPECT_EQ(at, 31'234U);
}

TEST(RecordPictures, AreThoseOfTheFileAsItIsNow) {
  const ServedFolder served;
  served.folder.write("long.csv", record_with_spike(50'000, 1000));
  EXPECT_EQ(highest_row(read_answer(served, whole("long.csv", 4000)), "u_V") / 16, 1000U / 16);
  served.folder.write("long.csv", record_with_spike(60'000, 55'000));
  const json told = read_answer(served, whole("long.csv", 4000));
  EXPECT_EQ(told["end"], 60'000);
  EXPECT_EQ(highest_row(told, "u_V") / 16, 55'000U / 16);
}

TEST(RecordPictures, RefuseByTheNameOfTheField) {
  const ServedFolder served;
  const TemporaryFolder elsewhere;
  elsewhere.write("secret.csv", record_with_spike(100, 5));
  std::filesystem::create_symlink(elsewhere.path("secret.csv"), "link.csv");
  served.folder.write("long.csv", record_with_spike(1000, 5));
  const auto answer = [&](const std::string& field, const json& value) {
    json request = whole("long.csv");
    request[field] = value;
    const auto [status, told] = served.post("/api/record", request);
    return fmt::format("{} {}", status, told.value("error", "accepted"));
  };
  using testing::AllOf;
  using testing::HasSubstr;
  using testing::StartsWith;
  for (const auto& [field, value] :
       std::vector<std::pair<std::string, json>>{{"from", -1},
                                                 {"from", 0.5},
                                                 {"to", 0},
                                                 {"to", "x"},
                                                 {"pixels", 0},
                                                 {"pixels", 4001},
                                                 {"pixels", 1e9},
                                                 {"channels", "u_V"},
                                                 {"channels", {"t_s"}},
                                                 {"channels", {"no"}},
                                                 {"channels", std::vector<std::string>(13, "u_V")},
                                                 {"record", "../long.csv"},
                                                 {"more", 1}})
    EXPECT_THAT(answer(field, value), AllOf(StartsWith("400"), HasSubstr(field))) << field << " " << value;
  EXPECT_THAT(answer("record", "link.csv"), StartsWith("403"));
  EXPECT_THAT(answer("record", "none.csv"), AllOf(StartsWith("422"), HasSubstr("no such file")));
  EXPECT_THAT(answer("channels", {"no"}), HasSubstr("u_V, x_mm"));
  EXPECT_EQ(served.post("/api/record", {{"record", "long.csv"}, {"from", 5000}, {"to", 6000}, {"pixels", 10}})
                .second["taken"],
            json::array());
}

TEST(RecordPictures, KeepNoMoreRecordsInMemoryThanTheirNumber) {
  const WorkingFolder working;
  const host::workbench::Folder folder;
  host::workbench::RecordPictures pictures(folder);
  std::vector<std::weak_ptr<const host::RecordPicture>> made;
  for (std::size_t k = 0; k < 2 * host::workbench::RecordPictures::kMost; ++k) {
    const std::string name = fmt::format("r{}.csv", k);
    working.folder.write(name, record_with_spike(100, 5));
    made.push_back(pictures.of(name));
    EXPECT_EQ(pictures.of(name), made.back().lock()) << "an unchanged file is read once";
  }
  EXPECT_EQ(std::ranges::count_if(made, [](const auto& one) { return !one.expired(); }),
            host::workbench::RecordPictures::kMost);
}

TEST(RecordPictures, AStretchThatIsKeptIsTheCommandsCut) {
  const ServedFolder served;
  served.folder.write("long.csv", record_with_spike(50'000, 31'234));
  read_answer(served, whole("long.csv"));
  const auto [status, told] =
      served.post("/api/cut", {{"record", "long.csv"}, {"stretch", {31.0, 31.5}}, {"keep", true}});
  ASSERT_EQ(status, 200) << told;
  EXPECT_EQ(told["pieces"], json({"long-31-31.5s.csv"}));
  EXPECT_EQ(told["commands"], json({"axistool cut long.csv --from 31 --to 31.5 -o long-31-31.5s.csv"}));
  const host::Record piece = host::read_record("long-31-31.5s.csv");
  EXPECT_EQ(piece.size(), 501U);
  EXPECT_EQ(piece.t_s.front(), 31.0);
  EXPECT_EQ(piece.t_s.back(), 31.5);
  EXPECT_EQ(piece.u_V[234], 9.5);
  EXPECT_EQ(served.post("/api/cut", {{"record", "long.csv"}, {"stretch", {90.0, 91.0}}, {"keep", true}}).first, 400);
}

TEST(RecordPictures, ShowWhatIsTooLongToBeCompared) {
  const ServedFolder served;
  served.copy_case("none/case-00");
  served.folder.write("long.csv", record_with_spike(1000, 5));
  std::filesystem::resize_file("long.csv", host::workbench::kComparedSize.bytes / 2);
  const auto refusal_with = [&](const json& models) {
    const auto [status, told] =
        served.post("/api/compare", {{"do", "compare"}, {"models", models}, {"records", {"long.csv"}}});
    return fmt::format("{} {}", status, told.value("error", "accepted"));
  };
  EXPECT_THAT(refusal_with({"model.toml", "model.toml", "model.toml"}),
              testing::AllOf(testing::StartsWith("422 192 MiB of records: a comparison in the workbench may have 128"),
                             testing::HasSubstr("axistool cut long.csv --from")));
  EXPECT_THAT(refusal_with({"model.toml"}), testing::Not(testing::HasSubstr("may have 128")))
      << "refused for its zeros";
}

}  // namespace
