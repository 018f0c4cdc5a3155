// Requests of a page, or of a program that pretends to be one.
#include "host/workbench/request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/exit_codes.hpp"
#include "tests/host/workbench/served_folder.hpp"

namespace {

using host::workbench::command_line;
using host::workbench::parse_choice;
using host::workbench::parse_request;

TEST(Request, BecomesTheCommandThatDoesTheSame) {
  EXPECT_EQ(command_line(parse_request(R"({"do":"compare","models":["a.toml","b.toml"],"records":["r 1.csv"],
                                           "accept":["sign","unit"]})"),
                         {}),
            "axistool compare a.toml b.toml 'r 1.csv' --accept sign --accept unit");
  EXPECT_EQ(command_line(parse_request(R"({"do":"add","model":"a.toml","kind":"free_curve","over":"speed",
                                           "train":["r.csv","s.csv"],"validate":["v.csv"]})"),
                         {"b.toml", "j.json", ""}),
            "axistool add a.toml free_curve --train r.csv s.csv --validate v.csv --over speed -o b.toml --json j.json");
  EXPECT_EQ(command_line(parse_request(R"({"do":"add","model":"a.toml","kind":"backlash+cogging","train":["r.csv"]})"),
                         {"b.toml", "", ""}),
            "axistool add a.toml backlash+cogging --train r.csv -o b.toml");
  EXPECT_EQ(command_line(parse_request(R"({"do":"diagnose","model":"a.toml","train":["r.csv"],"quick":true})"), {}),
            "axistool diagnose a.toml --quick --train r.csv");
  EXPECT_EQ(command_line(parse_request(R"({"do":"adjust","model":"a.toml","values":["cogging.cosine_72=-1e-3"],
                                           "train":["r.csv"]})"),
                         {"b.toml", "", ""}),
            "axistool adjust a.toml cogging.cosine_72=-1e-3 --train r.csv -o b.toml");
  EXPECT_EQ(
      command_line(parse_request(R"({"do":"diagnose","model":"$(x).toml","train":["r.csv"],"absent":["backlash"]})"),
                   {"", "j.json", "p.html"}),
      "axistool diagnose '$(x).toml' --train r.csv --absent backlash --json j.json --report p.html");
}

TEST(Request, WhatIsNoRequestIsRefusedWithTheFieldsName) {
  const ServedFolder served;
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"", "object"},
      {"[]", "object"},
      {"{\"do\":", "object"},
      {std::string(20'000, '['), "object"},
      {R"({"do":)" + std::string(20'000, '[') + std::string(20'000, ']') + "}", "do"},
      {"{}", "do"},
      {R"({"do":7})", "do"},
      {R"({"do":"format"})", "do"},
      {R"({"do":"diagnose"})", "model"},
      {R"({"do":"diagnose","model":"m.toml","train":"r.csv"})", "train"},
      {R"({"do":"diagnose","model":"m.toml","train":[1]})", "train"},
      {R"({"do":"diagnose","model":"m.toml","train":[]})", "train"},
      {R"({"do":"diagnose","model":"../m.toml","train":["r.csv"]})", "model"},
      {R"({"do":"diagnose","model":"m.toml","train":["-o"]})", "train"},
      {R"({"do":"diagnose","model":"m.toml","train":["r.csv"],"kind":"cogging"})", "kind"},
      {R"({"do":"diagnose","model":"m.toml","train":["r.csv"],"quick":1})", "quick"},
      {R"({"do":"improve","model":"m.toml","train":["r.csv"],"quick":true})", "quick"},
      {R"({"do":"diagnose","model":"m.toml","train":["r.csv"],"values":["a.b=1"]})", "values"},
      {R"({"do":"adjust","model":"m.toml","train":["r.csv"]})", "values"},
      {R"({"do":"adjust","model":"m.toml","train":["r.csv"],"values":["--json=x"]})", "values"},
      {R"({"do":"adjust","model":"m.toml","train":["r.csv"],"values":["a.b=`x`"]})", "values"},
      {R"({"do":"add","model":"m.toml","train":["r.csv"]})", "kind"},
      {R"({"do":"add","model":"m.toml","train":["r.csv"],"kind":"; rm"})", "kind"},
      {R"({"do":"compare","models":["m.toml"],"records":["r.csv"],"map":["speed"]})", "map"},
      {R"({"do":"compare","models":["m.toml"],"records":["r.csv"],"plot":["error","speed"]})", "plot"},
      {R"({"do":"compare","models":["m.toml"],"records":["r.csv"],"plot":["speed"]})", "plot"},
      {R"({"do":"compare","models":["m.toml"],"records":["r.csv"],"map":["speed","colour"]})", "map"},
      {R"({"do":"add","model":"m.toml","train":["r.csv"],"kind":"cogging","output":"x"})", "output"},
      {R"({"do":"commission","model":"m.toml","axis":"x"})", "box"},
      {R"({"do":"commission","model":"m.toml","axis":"","box":"travel=1"})", "axis"},
      {R"({"do":"commission","model":"m.toml","axis":"x","box":"travel=1","overtravel_mm":-1})", "overtravel_mm"},
      {R"({"do":"commission","model":"m.toml","axis":"x","box":"travel=1","folder":"../x"})", "folder"},
      {R"({"do":"commission","model":"m.toml","axis":"x","box":"travel=1","from":"look"})", "from"},
      {R"({"do":"commission","model":"m.toml","axis":"x","box":"travel=1","to":"nowhere"})", "nowhere"}};
  for (const auto& [text, field] : wrong) {
    const auto [status, told] = served.post_text("/api/jobs", text);
    EXPECT_EQ(status, 400) << text;
    EXPECT_THAT(told.value("error", ""), testing::HasSubstr(field)) << text;
  }
  EXPECT_EQ(served.post_text("/api/jobs", std::string(100'000, ' ')).first, 413);
  EXPECT_EQ(served.post_text("/api/compare", R"({"do":"diagnose","model":"m.toml","train":["r.csv"]})").first, 400);
  EXPECT_EQ(served.get("/api/jobs/1").first, 404);
  EXPECT_EQ(served.get("/api/jobs").second["jobs"].size(), 0U);
}

TEST(Request, WhatIsChosenIsKeptAndChecked) {
  const ServedFolder served;
  const nlohmann::json choice = {{"model", "m.toml"}, {"beside", {"n.toml"}}, {"roles", {{"r.csv", "judge"}}}};
  EXPECT_TRUE(served.get("/api/folder").second["choice"].is_null());
  EXPECT_EQ(served.post("/api/choice", choice).first, 200);
  EXPECT_EQ(served.get("/api/folder").second["choice"], choice);
  EXPECT_THROW(parse_choice(R"({"roles":{"r.csv":"maybe"}})"), host::Failure);
  EXPECT_THROW(parse_choice(R"({"roles":{"/r.csv":"train"}})"), host::Failure);
  served.folder.write("workbench/choice.json", "{ damaged");
  EXPECT_TRUE(served.get("/api/folder").second["choice"].is_null());
}

TEST(Request, ManyIdleAndBrokenConnectionsDoNotKeepThePageFromItsAnswer) {
  const ServedFolder served;
  std::vector<int> idle;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(served.server.port()));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  for (int k = 0; k < 200; ++k) {
    idle.push_back(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0));
    (void)::connect(idle.back(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  }
  EXPECT_EQ(served.get("/api/folder").first, 200);
  for (const int socket : idle) ::close(socket);
}

}  // namespace
