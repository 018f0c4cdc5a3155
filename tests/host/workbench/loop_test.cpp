// The page designs as the command does.
#include "host/workbench/loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/exit_codes.hpp"
#include "host/parameters/parameter_file.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/workbench/served_folder.hpp"

namespace {

using nlohmann::json;

TEST(LoopRequest, BecomesTheCommandAndWhatIsNoneIsRefused) {
  using host::workbench::loop_command;
  using host::workbench::parse_loop;
  EXPECT_EQ(loop_command(parse_loop(R"({"model":"a b.toml","response":["r.json"],"fc":42.5,"notch":[110,0.5,0.1],
                                        "low_pass":[200,0.7]})"),
                         "p.toml"),
            "axistool design 'a b.toml' --fc 42.5 --zeta 0.7 --response r.json --notch 110,0.5,0.1 --low-pass 200,0.7 "
            "-o p.toml");
  EXPECT_EQ(loop_command(parse_loop(R"({"model":"m.toml","response":["model"],"margin":0.5,"notch":"auto"})"), ""),
            "axistool design m.toml --fc 30 --zeta 0.7 --response model --margin 0.5 --notch auto");
  for (const auto& [text, field] : std::vector<std::pair<std::string, std::string>>{
           {R"({"response":["model"]})", "model"},
           {R"({"model":"../m.toml","response":["model"]})", "model"},
           {R"({"model":"m.toml"})", "response"},
           {R"({"model":"m.toml","response":["-o"]})", "response"},
           {R"({"model":"m.toml","response":["model"],"fc":0})", "fc"},
           {R"({"model":"m.toml","response":["model"],"zeta":"1"})", "zeta"},
           {R"({"model":"m.toml","response":["model"],"notch":[100]})", "notch"},
           {R"({"model":"m.toml","response":["model"],"notch":"here"})", "notch"},
           {R"({"model":"m.toml","response":["model"],"low_pass":[-1,1]})", "low_pass"},
           {R"({"model":"m.toml","response":["model"],"margin":1})", "margin"},
           {R"({"model":"m.toml","response":["model"],"write":1})", "write"}}) {
    std::string said = "accepted";
    try {
      parse_loop(text);
    } catch (const host::Failure& failure) {
      EXPECT_EQ(failure.code, host::ExitCode::usage);
      said = failure.what();
    }
    EXPECT_THAT(said, testing::HasSubstr(field)) << text;
  }
}

TEST(Loop, FiguresAndParametersAreTheCommands) {
  const ServedFolder served;
  served.copy_case("none/case-00");
  const json request = {{"model", "model.toml"}, {"response", {"model"}}, {"fc", 40.0}, {"notch", {150.0, 0.3, 0.2}}};
  const auto [status, told] = served.post("/api/loop", request);
  ASSERT_EQ(status, 200) << told;
  EXPECT_EQ(told["written"], "");
  EXPECT_FALSE(std::filesystem::exists("model-params.toml")) << "nothing is written before it is wished";
  const ProgramRun run = run_axistool(
      told["command"].get<std::string>().substr(std::string("axistool ").size()) + " --json -", "2>/dev/null");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_EQ(json::parse(run.output), told["document"]);

  json writing = request;
  writing["write"] = true;
  const json written = served.post("/api/loop", writing).second;
  EXPECT_EQ(written["written"], "model-params.toml");
  EXPECT_GT(host::read_parameter_file("model-params.toml").size(), 20U);
  EXPECT_EQ(served.post("/api/loop", writing).second["written"], "model-params-2.toml") << "overwrites nothing";
  json unstable = request;
  unstable["fc"] = 400.0;
  EXPECT_EQ(served.post("/api/loop", unstable).first, 422);
}

}  // namespace
