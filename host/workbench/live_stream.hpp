// The stream of a board's channels to a page, as Server-Sent Events.
#pragma once

#include <atomic>
#include <cstddef>

#include "host/workbench/live.hpp"

namespace httplib {
struct Request;
struct Response;
}  // namespace httplib

namespace host::workbench {

/// Streams at once, each of which occupies a thread of the server.
inline constexpr std::size_t kMostStreams = 16;

/// Answers with events "rows" (Live::next_event) and, five times a second, "state". Fields of the query: "rows" of a
/// bucket (0: only states) and "back", rows of the past. After an interruption the browser continues behind the last
/// row that it has. Ends with `is_ending` or with the page. Throws Failure: usage, refused (too many streams).
void stream_live(const Live& live, const httplib::Request& query, httplib::Response& response,
                 std::atomic<std::size_t>& streams, const std::atomic<bool>& is_ending);

}  // namespace host::workbench
