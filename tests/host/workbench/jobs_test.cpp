// The page's actions produce the same documents as the commands, even if the page is reloaded or closed meanwhile.
#include "host/workbench/jobs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "host/cancellation.hpp"
#include "host/exit_codes.hpp"
#include "host/read_file.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/workbench/served_folder.hpp"
#include "tests/wait_until.hpp"

namespace {

using host::workbench::Folder;
using host::workbench::Jobs;
using host::workbench::parse_request;
using host::workbench::Request;
using nlohmann::json;

/// Runs the command line that the page shows; its JSON goes to standard output instead of the file of the job.
json document_of(const std::string& command) {
  const std::size_t outputs = command.find(" --json ");
  const ProgramRun run = run_axistool(
      command.substr(9, outputs == std::string::npos ? outputs : outputs - 9) + " --json -", "2>/dev/null");
  return json::parse(run.output, nullptr, false);
}

const json kAdd = {{"do", "add"},
                   {"model", "model.toml"},
                   {"kind", "cogging"},
                   {"train", {"train-jog.csv"}},
                   {"validate", {"validate.csv"}}};
const json kDiagnose = {
    {"do", "diagnose"}, {"model", "model.toml"}, {"train", {"train-jog.csv"}}, {"validate", {"validate.csv"}}};

TEST(Jobs, AComparisonIsThatOfTheCommand) {
  const ServedFolder served;
  served.copy_case("single/case-00");
  std::filesystem::copy("model.toml", "other.toml");
  for (const json& models : {json{"model.toml"}, json{"model.toml", "other.toml"}}) {
    const auto [status, told] = served.post(
        "/api/compare", json{{"do", "compare"}, {"models", models}, {"records", {"train-jog.csv", "validate.csv"}}});
    ASSERT_EQ(status, 200) << told;
    EXPECT_EQ(told["document"]["format"], "axis-comparison/1");
    EXPECT_EQ(told["document"], document_of(told["command"]));
    EXPECT_THAT(told["report"].get<std::string>(), testing::HasSubstr("After a reversal"));
  }
}

TEST(Jobs, AComparisonAsAJobIsTheSameAndSharesNothingWithOthers) {
  const ServedFolder served;
  served.copy_case("single/case-00");
  const json request = {{"do", "compare"}, {"models", {"model.toml"}}, {"records", {"train-jog.csv", "validate.csv"}}};
  const json at_once = served.post("/api/compare", request).second;
  const int first = served.post("/api/jobs", request).second["id"];
  const int other = served.post("/api/jobs", request).second["id"];
  served.post("/api/jobs/" + std::to_string(other) + "/cancel", json::object());
  const json state = served.ended(first);
  ASSERT_EQ(state["state"], "done") << state;
  EXPECT_EQ(state["document"], at_once["document"]);
  EXPECT_EQ(state["document"], document_of(state["command"]));
  EXPECT_EQ(state["traces"], at_once["traces"]);
  EXPECT_EQ(host::read_file(state["report"].get<std::string>()), at_once["report"].get<std::string>());
  EXPECT_EQ(state["model"], "");
  EXPECT_NE(served.ended(other)["state"], "failed");
  json like = request;
  like["like"] = "speed";
  EXPECT_EQ(served.post("/api/jobs", like).first, 400);
}

TEST(Jobs, AFirstLookIsThatOfTheQuickCommandAndNamesWhatCogs) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const ServedFolder served;
  served.copy_case("single/case-00");
  json request = kDiagnose;
  EXPECT_EQ(served.post("/api/look", request).first, 400) << "a whole search is a job";
  request["quick"] = true;
  const auto [status, told] = served.post("/api/look", request);
  ASSERT_EQ(status, 200) << told;
  EXPECT_EQ(told["document"]["verdict"]["effects"], json{"cogging"});
  EXPECT_EQ(told["document"], document_of(told["command"]));
  EXPECT_THAT(told["report"].get<std::string>(), testing::HasSubstr("What was found"));
}

TEST(Jobs, ATrialChangesNoModelAndAnAdjustmentIsThatOfTheCommand) {
  const ServedFolder served;
  served.copy_case("single/case-00");
  const std::string model = host::read_file("model.toml");
  json request = {{"do", "adjust"},
                  {"model", "model.toml"},
                  {"values", {"inertia.J=0.009"}},
                  {"train", {"train-jog.csv"}},
                  {"validate", {"validate.csv"}}};
  const auto [status, told] = served.post("/api/trial", request);
  ASSERT_EQ(status, 200) << told;
  EXPECT_EQ(host::read_file("model.toml"), model);
  const json compared = document_of("axistool compare model.toml workbench/trial.toml validate.csv");
  EXPECT_EQ(told["document"], compared);
  const json done = served.ended(served.post("/api/jobs", request).second["id"]);
  ASSERT_EQ(done["state"], "done") << done;
  EXPECT_EQ(done["model"], "model-adjusted.toml");
  EXPECT_GT(done["document"]["error"]["after"]["validate"]["combined"].get<double>(),
            done["document"]["error"]["given"]["validate"]["combined"].get<double>())
      << "half as much again as this machine's inertia";
  const std::string written = host::read_file("model-adjusted.toml");
  EXPECT_NE(written, model);
  EXPECT_EQ(document_of(done["command"]), done["document"]);
  EXPECT_EQ(host::read_file("model-adjusted.toml"), written);
  for (const char* wrong : {"inertia.J=-1", "inertia.K=1", "inertia.J=nan"}) {
    request["values"] = {wrong};
    EXPECT_EQ(served.post("/api/trial", request).first, 400) << wrong;
  }
}

TEST(Jobs, WhatIsLookedAtChangesPicturesAndNoFigure) {
  const ServedFolder served;
  served.copy_case("single/case-00");
  json request = {{"do", "compare"}, {"models", {"model.toml"}}, {"records", {"train-jog.csv", "validate.csv"}}};
  const json plain = served.post("/api/compare", request).second;
  EXPECT_EQ(plain["traces"], "validate.csv") << "the larger error";
  request.update(
      {{"traces", "train-jog.csv"}, {"stretch", {1.0, 2.0}}, {"period_mm", 1.25}, {"map", {"time", "acceleration"}}});
  const auto [status, told] = served.post("/api/compare", request);
  ASSERT_EQ(status, 200) << told;
  EXPECT_EQ(told["document"], plain["document"]);
  EXPECT_EQ(told["document"], document_of(told["command"]));
  for (const char* shown : {"Measured and predicted: train-jog.csv", "Within one period of 1.25 mm",
                            "1 to 2 s, forward", "Time since start and acceleration", "Spectrum"})
    EXPECT_THAT(told["report"].get<std::string>(), testing::HasSubstr(shown));
  request["traces"] = "train-sweep.csv";
  EXPECT_EQ(served.post("/api/compare", request).first, 400) << "not among them";
}

TEST(Jobs, AStretchIsLeftOutByCut) {
  const ServedFolder served;
  served.copy_case("single/case-00");
  const auto [status, told] = served.post("/api/cut", json{{"record", "validate.csv"}, {"stretch", {1.0, 2.0}}});
  ASSERT_EQ(status, 200) << told;
  ASSERT_EQ(told["pieces"], (json{"validate-to-1s.csv", "validate-from-2s.csv"}));
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string piece = told["pieces"][k], written = host::read_file(piece);
    std::filesystem::remove(piece);
    EXPECT_EQ(run_axistool(told["commands"][k].get<std::string>().substr(9)).exit_code, 0);
    EXPECT_EQ(host::read_file(piece), written);
  }
  EXPECT_EQ(served.post("/api/cut", json{{"record", "validate.csv"}, {"stretch", {-1.0, 9.0}}}).first, 422);
  EXPECT_EQ(served.post("/api/cut", json{{"record", "validate.csv"}, {"stretch", {2.0, 1.0}}}).first, 400);
}

TEST(Jobs, AModelIsIdentifiedFromADataSheetAsTheCommandDoes) {
  const ServedFolder served;
  served.copy_case("single/case-00");
  const std::string model = host::read_file("model.toml");
  served.folder.write("sheet.toml", model.substr(0, model.find("[[effect]]")));
  const int id = served.post("/api/jobs", {{"do", "identify"}, {"model", "sheet.toml"}, {"train", {"train-jog.csv"}}})
                     .second["id"];
  const json state = served.ended(id);
  ASSERT_EQ(state["state"], "done") << state;
  EXPECT_EQ(state["model"], "sheet-identified.toml");
  const std::string written = host::read_file("sheet-identified.toml");
  EXPECT_EQ(document_of(state["command"]), state["document"]);
  EXPECT_EQ(host::read_file("sheet-identified.toml"), written);
}

TEST(Jobs, ALogOfAnotherControllerBecomesRecordsOnceItIsUnderstood) {
  const ServedFolder served;
  served.copy_case("single/case-00");
  std::string log = host::read_file("validate.csv");
  log.replace(0, log.find("\n0.000,"), "Time [s];Command Voltage [V];ActPos [mm];ActVel [rad/s]");
  std::ranges::replace(log, ',', ';');
  served.folder.write("trace.csv", log);
  for (const bool yes : {false, true}) {
    const auto [status, told] = served.post("/api/open", {{"logs", {"trace.csv"}}, {"yes", yes}});
    ASSERT_EQ(status, 200) << told;
    const bool written = yes || told["document"]["asks"].empty();
    EXPECT_EQ(told["document"]["records"].size(), written ? 1U : 0U) << told;
    if (written) std::filesystem::remove_all("trace");
    EXPECT_EQ(document_of(told["command"]), told["document"]);
    std::filesystem::remove_all("trace");
  }
}

TEST(Jobs, AnAdditionIsThatOfTheCommandAndNeitherReloadNorCrashLosesIt) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  json first;
  const ServedFolder served;
  served.copy_case("single/case-00");
  const auto [status, told] = served.post("/api/jobs", kAdd);
  ASSERT_EQ(status, 200) << told;
  first = served.ended(told["id"]);
  ASSERT_EQ(first["state"], "done") << first;
  EXPECT_EQ(first["model"], "model+cogging.toml");
  const json& error = first["document"]["error"];
  EXPECT_LT(error["after"]["validate"]["combined"].get<double>(),
            0.5 * error["given"]["validate"]["combined"].get<double>())
      << "this machine cogs";
  EXPECT_EQ(json::parse(host::read_file("workbench/0001-add.json")), first["document"]);
  const std::string written = host::read_file("model+cogging.toml");
  json again = document_of(first["command"]);
  EXPECT_EQ(again, first["document"]);
  EXPECT_EQ(host::read_file("model+cogging.toml"), written) << "the same file by the command";

  const json look = {{"do", "compare"}, {"models", {"model+cogging.toml"}}, {"records", {"validate.csv"}}};
  const std::string story = served.post("/api/story", look).second.value("report", "");
  for (const char* told_there :
       {"+ cogging", "model+cogging.toml predicts best", "cogging.period", "-o model+cogging.toml"})
    EXPECT_THAT(story, testing::HasSubstr(told_there));

  // Another session on the folder, in which a job was running when the last session crashed.
  json crashed = json::parse(host::read_file("workbench/0001.job.json"));
  crashed["id"] = 2;
  crashed["state"] = "running";
  served.folder.write("workbench/0002.job.json", crashed.dump());
  served.folder.write("workbench/0003.job.json", "{ \"format\": \"axis-job/1\", \"id\": [] }");
  served.folder.write("workbench/0004.job.json", "damaged");
  const Folder folder;
  Jobs jobs(folder);
  EXPECT_EQ(jobs.state(1)->at("document"), first["document"]);
  EXPECT_EQ(jobs.state(2)->at("state"), "interrupted");
  EXPECT_FALSE(jobs.state(3));
  EXPECT_EQ(jobs.list()["jobs"].size(), 2U);
}

TEST(Jobs, ACommissioningsCommandHasTheUnitsOfTheDrive) {
  Request request = parse_request(
      R"({"do":"commission","model":"d.toml","axis":"x","box":"travel=80mm,time=9s","overtravel_mm":5,"folder":"x","from":"look"})");
  const std::string begin = "axistool commission x --drive d.toml --box travel=80mm,time=9s -o x --overtravel ";
  EXPECT_EQ(command_line(request, {}), begin + "5 --from look");
  request.commission->is_linear = true;
  EXPECT_EQ(command_line(request, {}), begin + "0.005 --from look");
}

TEST(Jobs, ACommissioningTellsItsStepRunsAloneAndContinues) {
  const WorkingFolder here;
  const Folder folder;
  std::atomic<bool> is_done = false;
  Jobs jobs(folder, [&](const Request& request, const Jobs::Tell& tell) {
    tell(0.25, "a step");
    while (!is_done && !host::is_cancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (request.commission->from.empty()) throw host::Failure(host::ExitCode::device_fault, "stopped");
    return json{{"page", "x/page.html"}};
  });
  const auto becomes = [&](int id, const std::string& state) {
    return wait_until([&] { return jobs.state(id)->at("state") == state; });
  };
  json text = {{"do", "commission"}, {"owner", "key"}, {"model", "d.toml"}, {"axis", "x"}, {"box", "travel=80"}};
  const int first = jobs.submit(parse_request(text.dump()));
  ASSERT_TRUE(wait_until([&] { return jobs.state(first)->at("message") == "a step"; }));
  EXPECT_EQ(jobs.state(first)->at("share"), 0.25);
  EXPECT_FALSE(jobs.state(first)->at("request").contains("owner"));
  EXPECT_EQ(jobs.state(first)->at("command"),
            "axistool commission x --drive d.toml --box travel=80 -o x --json workbench/0001-commission.json");
  EXPECT_THROW(jobs.submit(parse_request(text.dump())), host::Failure) << "one at a time";
  is_done = true;
  ASSERT_TRUE(becomes(first, "failed"));
  EXPECT_EQ(jobs.state(first)->at("next"), "look");
  text["folder"] = "x";
  text["from"] = "look";
  EXPECT_THROW(jobs.submit(parse_request(text.dump())), host::Failure) << "there is no commissioning in the folder";
  here.folder.write("x/commission.json", "{}");
  const int second = jobs.submit(parse_request(text.dump()));
  ASSERT_TRUE(becomes(second, "done"));
  EXPECT_EQ(jobs.state(second)->at("report"), "x/page.html");
  is_done = false;
  text.erase("folder");
  text.erase("from");
  const int third = jobs.submit(parse_request(text.dump()));
  ASSERT_TRUE(wait_until([&] { return jobs.state(third)->at("message") == "a step"; }));
  jobs.cancel(third);
  EXPECT_TRUE(becomes(third, "cancelled"));
  Jobs without(folder);
  EXPECT_THROW(without.submit(parse_request(text.dump())), host::Failure) << "without a board";
}

TEST(Jobs, ACancelledJobEndsAtOnceAndTheNextOneBegins) {
  const ServedFolder served;
  served.copy_case("single/case-00");
  const int running = served.post("/api/jobs", kDiagnose).second["id"];
  const int waiting = served.post("/api/jobs", kDiagnose).second["id"];
  const int last = served
                       .post("/api/jobs",
                             [] {
                               json request = kDiagnose;
                               request["train"] = {"none.csv"};
                               return request;
                             }())
                       .second["id"];
  EXPECT_EQ(served.post("/api/jobs/" + std::to_string(waiting) + "/cancel", json::object()).first, 200);
  EXPECT_EQ(served.ended(waiting)["state"], "cancelled");
  EXPECT_EQ(served.get("/api/jobs/" + std::to_string(running)).second["state"], "running");
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_EQ(served.post("/api/jobs/" + std::to_string(running) + "/cancel", json::object()).first, 200);
  EXPECT_EQ(served.ended(running)["state"], "cancelled");
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(kInstrumented ? 60 : 10));
  EXPECT_FALSE(std::filesystem::exists("workbench/0001-diagnose.json"));
  const json failed = served.ended(last);
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_THAT(failed["message"].get<std::string>(), testing::HasSubstr("none.csv"));
  EXPECT_EQ(served.post("/api/jobs/99/cancel", json::object()).first, 404);
}

TEST(Jobs, TheServerEndsInTheMiddleOfOne) {
  const auto begun = std::chrono::steady_clock::now();
  {
    const ServedFolder served;
    served.copy_case("single/case-00");
    ASSERT_EQ(served.post("/api/jobs", kDiagnose).first, 200);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(kInstrumented ? 60 : 15));
}

}  // namespace
