#include "host/workbench/live_stream.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <charconv>
#include <chrono>
#include <memory>
#include <string_view>
#include <thread>

#include "host/exit_codes.hpp"

namespace host::workbench {

namespace {

constexpr std::chrono::milliseconds kStateInterval{200}, kBatch{50};
constexpr std::uint64_t kMostBack = SampleRing::kSteps * SampleRing::kStep;

std::uint64_t count_of(std::string_view text, const char* field) {
  std::uint64_t value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc{} || end != text.data() + text.size() || value > kMostBack)
    throw Failure(ExitCode::usage, fmt::format("{}: expected a number of rows", field));
  return value;
}

/// A stream that is counted during its lifetime.
struct CountedView {
  CountedView(Live::View wanted, std::atomic<std::size_t>& streams) : view(wanted), streams_(streams) {}
  CountedView(const CountedView&) = delete;
  CountedView& operator=(const CountedView&) = delete;
  ~CountedView() { --streams_; }

  Live::View view;
  std::chrono::steady_clock::time_point next_state{};

 private:
  std::atomic<std::size_t>& streams_;
};

}  // namespace

void stream_live(const Live& live, const httplib::Request& query, httplib::Response& response,
                 std::atomic<std::size_t>& streams, const std::atomic<bool>& is_ending) {
  Live::View wanted{count_of(query.get_param_value("rows"), "rows"), count_of(query.get_param_value("back"), "back"), 0,
                    0};
  const std::string heard = query.get_header_value("Last-Event-ID");
  if (const std::size_t dash = heard.find('-'); dash != std::string::npos) {
    wanted.epoch = count_of(std::string_view(heard).substr(0, dash), "Last-Event-ID");
    wanted.next = count_of(std::string_view(heard).substr(dash + 1), "Last-Event-ID");
  }
  if (++streams > kMostStreams) {
    --streams;
    throw Failure(ExitCode::refused, fmt::format("{} pages look already", kMostStreams));
  }
  const auto counted = std::make_shared<CountedView>(wanted, streams);
  response.set_chunked_content_provider(
      "text/event-stream", [&live, &is_ending, counted](std::size_t, httplib::DataSink& sink) {
        std::this_thread::sleep_for(kBatch);
        std::string text = counted->view.rows > 0 ? live.next_event(counted->view) : "";
        const auto now = std::chrono::steady_clock::now();
        if (now >= counted->next_state) {
          counted->next_state = now + kStateInterval;
          text += fmt::format("event: state\ndata: {}\n\n",
                              live.state().dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
        }
        if (is_ending)
          sink.done();
        else if (!text.empty())
          sink.write(text.data(), text.size());
        return true;
      });
}

}  // namespace host::workbench
