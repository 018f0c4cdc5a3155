// A firmware with another format of path nodes than axistool's is refused before an axis moves.
#include <gtest/gtest.h>

#include <deque>

#include "host/device/path_run.hpp"
#include "host/exit_codes.hpp"

namespace {

/// Answers open_path like firmware without a node format: only 32 bits of room.
class OlderBoard : public host::ReportLink {
 public:
  void send(const hal::HidReport& report) override {
    firmware::Message request;
    ASSERT_EQ(firmware::decode(report, request), firmware::Status::ok);
    firmware::Message reply;
    reply.type = firmware::reply_to(request.type);
    reply.sequence = request.sequence;
    reply.client = request.client;
    if (request.type == firmware::MessageType::open_path) {
      std::array<std::uint32_t, firmware::kPayloadSize / 4> words{};
      words.back() = 400;
      reply.put(words);
    }
    replies_.push_back(firmware::encode(reply));
  }
  std::optional<hal::HidReport> receive(std::chrono::milliseconds) override {
    if (replies_.empty()) return std::nullopt;
    const hal::HidReport first = replies_.front();
    replies_.pop_front();
    return first;
  }
  std::string name() const override { return "older"; }

 private:
  std::deque<hal::HidReport> replies_;
};

/// Catches a program that assumes that every board with paths can read its nodes.
TEST(PathNodeFormat, ABoardThatReadsNodesAnotherWayIsRefusedByName) {
  host::BoardClient board(std::make_unique<OlderBoard>());
  host::PathScale scale;
  scale.axes = {0, 1};
  try {
    host::path_start(board, scale, true);
    FAIL() << "a path was opened";
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::protocol);
    EXPECT_NE(std::string(failure.what()).find("format 0"), std::string::npos) << failure.what();
  }
}

}  // namespace
