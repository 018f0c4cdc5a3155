// Requests to a board, from a page or from a program that pretends to be one.
#include "host/workbench/live_request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/device/board_report.hpp"
#include "host/exit_codes.hpp"
#include "host/record/read_record.hpp"
#include "tests/firmware/app/paper_values.hpp"
#include "tests/host/board_at_a_socket.hpp"
#include "tests/host/workbench/served_folder.hpp"
#include "tests/wait_until.hpp"

namespace {

using namespace host::workbench;
using nlohmann::json;

/// The field that the message names.
template <typename Parse>
std::string refused(Parse parse, const std::string& text) {
  try {
    parse(text);
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::usage) << text;
    return failure.what();
  }
  return "accepted";
}

TEST(LiveRequest, WhatIsNoneIsRefusedWithTheFieldsName) {
  using testing::HasSubstr;
  for (const auto& [text, field] :
       std::vector<std::pair<std::string, std::string>>{{"", "object"},
                                                        {R"({"do":"fly","axis":"x"})", "do"},
                                                        {R"({"do":"jog","axis":"x"})", "velocity"},
                                                        {R"({"do":"jog","axis":"x","velocity":"5"})", "velocity"},
                                                        {R"({"do":"jog","axis":"x","velocity":1e999})", "object"},
                                                        {R"({"do":"jog","velocity":5})", "axis"},
                                                        {R"({"do":"enable","axis":"x","velocity":5})", "velocity"},
                                                        {R"({"do":"halt","axis":"x"})", "axis"},
                                                        {R"({"do":"halt","owner":1})", "owner"},
                                                        {R"({"do":"halt","more":1})", "more"}})
    EXPECT_THAT(refused(parse_motion, text), HasSubstr(field)) << text;
  for (const char* text :
       {"{}", R"({"values":{}})", R"({"values":{"a":1}})", R"({"values":[]})", R"({"values":{"a":"\n"}})"})
    EXPECT_THAT(refused(parse_parameters, text), HasSubstr("values")) << text;
  for (const char* text : {"{}", R"({"epoch":1,"from":-1,"to":2})", R"({"epoch":1,"from":0.5,"to":2})"})
    EXPECT_THAT(refused(parse_rows, text), HasSubstr("whole number")) << text;
  EXPECT_THAT(refused(parse_trigger_wish, R"({"axis":"x","trigger":"x.now","before_s":-1,"after_s":1})"),
              HasSubstr("before_s"));
  EXPECT_THAT(refused(parse_trigger_wish, R"({"axis":"x","before_s":1,"after_s":1})"), HasSubstr("trigger"));
  EXPECT_THAT(refused(parse_channels, R"({"channels":["x\u0007"]})"), HasSubstr("channels"));
  EXPECT_EQ(parse_parameters(R"({"values":{"x.a":"1"}})").assignments, std::vector<std::string>{"x.a=1"});
}

TEST(LiveRoutes, WithoutABoardThePageSaysSoAndNothingElseAnswers) {
  const ServedFolder served;
  EXPECT_EQ(served.get("/api/live"), (std::pair<int, json>(200, {{"device", nullptr}})));
  for (const char* path : {"/api/live/stream", "/api/live/parameters"}) EXPECT_EQ(served.get(path).first, 422) << path;
  for (const char* path : {"claim", "beat", "stop", "motion", "channels", "trigger", "save", "rows", "parameters"})
    EXPECT_EQ(served.post(std::string("/api/live/") + path, json::object()).first, 422) << path;
}

class ServedBoard : public testing::Test {
 protected:
  json moved(json request) const { return served_.post("/api/live/motion", request).second; }
  bool is_x(const std::string& state) const { return host::state_text(board_.client().status().axis.at(0)) == state; }

  const BoardAtASocket board_{firmware_test::paper_values()};
  const ServedFolder served_{{board_.device(), 1.0}};
};

TEST_F(ServedBoard, ObeysOnlyWithTokenOriginAndOwnersKey) {
  httplib::Headers foreign = served_.own;
  foreign.emplace("Origin", "http://evil.example");
  for (const char* path : {"claim", "stop", "motion"}) {
    const std::string whole = std::string("/api/live/") + path;
    EXPECT_EQ(served_.client().Post(whole, {}, "{}", "application/json")->status, 403);
    EXPECT_EQ(served_.client().Post(whole, foreign, "{}", "application/json")->status, 403);
    EXPECT_EQ(served_.client().Get(whole, served_.own)->status, 404) << "what changes something needs a POST";
  }
  EXPECT_EQ(served_.client().Get("/api/live/stream", httplib::Headers{})->status, 403);
  ASSERT_TRUE(wait_until([&] { return is_x("ready"); }));
  const std::string key = served_.post("/api/live/claim", json::object()).second["owner"];
  EXPECT_TRUE(moved({{"owner", key + "0"}, {"do", "enable"}, {"axis", "x"}}).contains("error"));
  EXPECT_TRUE(moved({{"do", "enable"}, {"axis", "x"}}).contains("error"));
  EXPECT_TRUE(is_x("ready"));
  EXPECT_EQ(moved({{"owner", key}, {"do", "enable"}, {"axis", "x"}})["command"],
            "axistool enable x --device " + board_.device());
  EXPECT_TRUE(wait_until([&] {
    served_.post("/api/live/beat", {{"owner", key}});
    return is_x("enabled");
  }));
  EXPECT_TRUE(moved({{"owner", key}, {"do", "jog"}, {"axis", "x"}, {"velocity", 1e6}}).contains("error"))
      << "beyond its limit";
  EXPECT_TRUE(moved({{"owner", key}, {"do", "jog"}, {"axis", "q"}, {"velocity", 1}}).contains("error"));
  EXPECT_EQ(served_.post("/api/live/stop", json::object()).first, 200);
  EXPECT_TRUE(wait_until([&] { return is_x("ready"); }));
  EXPECT_EQ(served_.post("/api/live/beat", {{"owner", key}}).first, 422) << "after STOP nobody commands";
}

TEST_F(ServedBoard, StreamsEveryRowOnceAlsoAfterAnInterruption) {
  std::uint64_t next = 0, rows = 0, events = 0;
  std::string id;
  const auto look = [&](const httplib::Headers& headers) {
    std::string text;
    served_.client().Get("/api/live/stream?rows=5&back=0", headers, [&](const char* data, std::size_t size) {
      text.append(data, size);
      for (std::size_t end = text.find("\n\n"); end != std::string::npos; end = text.find("\n\n")) {
        const std::string event = text.substr(0, end);
        text.erase(0, end + 2);
        if (!event.starts_with("event: rows")) continue;
        const json told = json::parse(event.substr(event.find("data: ") + 6));
        EXPECT_EQ(told["first"], next == 0 ? told["first"].get<std::uint64_t>() : next)
            << "none is lost, none comes twice";
        const std::size_t buckets = told["taken"].size();
        EXPECT_EQ(told["low"].size(), 8U);
        EXPECT_EQ(told["high"][7].size(), buckets);
        next = told["first"].get<std::uint64_t>() + 5 * buckets;
        rows += 5 * buckets;
        id = event.substr(event.find("id: ") + 4);
        id.erase(id.find('\n'));
        if (++events % 5 == 0) return false;
      }
      return true;
    });
  };
  look(served_.own);
  httplib::Headers again = served_.own;
  again.emplace("Last-Event-ID", id);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  look(again);
  EXPECT_EQ(events, 10U);
  EXPECT_GT(rows, 300U) << "with the rows of the interruption";
  EXPECT_EQ(served_.client().Get("/api/live/stream?rows=a", served_.own)->status, 400);
  EXPECT_EQ(served_.client().Get("/api/live/stream?rows=9999999999", served_.own)->status, 400);
}

TEST_F(ServedBoard, SavesRowsAsRecordsAndTakesParametersBack) {
  ASSERT_TRUE(wait_until([&] {
    return served_.post("/api/live/rows", {{"epoch", 1}, {"from", 0}, {"to", 200}}).second["taken"].size() == 200;
  }));
  const json saved = served_.post("/api/live/save", {{"epoch", 1}, {"from", 50}, {"to", 200}}).second;
  EXPECT_EQ(saved["records"], json({"live-x.csv"}));
  const host::Record record = host::read_record("live-x.csv");
  EXPECT_EQ(record.size(), 150U);
  EXPECT_EQ(record.t_s.back(), 0.149);
  EXPECT_TRUE(served_.post("/api/live/save", {{"epoch", 1}, {"from", 50}, {"to", 52}}).second.contains("error"));

  const auto value = [&](const std::string& name) {
    const json told = served_.get("/api/live/parameters").second;
    for (const json& one : told["parameters"])
      if (one["name"] == name) return one["value"].get<std::string>();
    return std::string();
  };
  ASSERT_TRUE(wait_until([&] { return is_x("ready"); }));
  const std::string before = value("x.limits.velocity");
  const std::string key = served_.post("/api/live/claim", json::object()).second["owner"];
  const auto with_key = [&](json body) { return body["owner"] = key, body; };
  EXPECT_EQ(served_
                .post("/api/live/parameters",
                      with_key({{"values", {{"x.limits.velocity", "12.5"}, {"x.limits.jerk", "1e99"}}}}))
                .first,
            400)
      << "all or none";
  EXPECT_EQ(value("x.limits.velocity"), before);
  EXPECT_EQ(served_.post("/api/live/parameters", with_key({{"values", {{"x.limits.velocity", "12.5"}}}})).first, 200);
  EXPECT_TRUE(wait_until([&] { return value("x.limits.velocity") == "12.5"; })) << value("x.limits.velocity");
  // This test does not beat, so its ownership has ended meanwhile.
  std::string next;
  ASSERT_TRUE(wait_until([&] {
    const auto [status, told] = served_.post("/api/live/claim", json::object());
    if (status == 200) next = told["owner"];
    return status == 200;
  }));
  EXPECT_EQ(served_.post("/api/live/parameters/undo", {{"owner", next}}).first, 200);
  EXPECT_TRUE(wait_until([&] { return value("x.limits.velocity") == before; }));
  EXPECT_EQ(served_.post("/api/live/parameters/undo", {{"owner", next}}).first, 422) << "nothing is left to undo";
  const json staged =
      served_
          .post("/api/live/parameters/file",
                {{"text", "format = \"axis-params/1\"\n[x.limits]\nvelocity = 33\n"}, {"name", "a.toml"}, {"axis", ""}})
          .second;
  EXPECT_EQ(staged["values"], json({{"x.limits.velocity", "33.0"}}));
}

}  // namespace
