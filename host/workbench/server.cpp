#include "host/workbench/server.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <utility>

#include "host/atomic_file.hpp"
#include "host/cancellation.hpp"
#include "host/evidence/log_faults.hpp"
#include "host/exit_codes.hpp"
#include "host/input_limits.hpp"
#include "host/model/model_file.hpp"
#include "host/read_file.hpp"
#include "host/report/effect_pages.hpp"
#include "host/stop_notice.hpp"
#include "host/workbench/access.hpp"
#include "host/workbench/actions.hpp"
#include "host/workbench/folder.hpp"
#include "host/workbench/jobs.hpp"
#include "host/workbench/live.hpp"
#include "host/workbench/live_stream.hpp"
#include "host/workbench/loop.hpp"
#include "host/workbench/page_files.hpp"
#include "host/workbench/record_pictures.hpp"
#include "host/workbench/request.hpp"
#include "host/workbench/story.hpp"

// Last: its <resolv.h> defines _res as a macro, and Eigen uses that name.
#include <httplib.h>

namespace host::workbench {

namespace {

using httplib::ContentReader;
using Query = httplib::Request;
using httplib::Response;
using Clock = std::chrono::steady_clock;

enum Status { ok = 200, bad_request = 400, forbidden = 403, not_found = 404, too_large = 413, refused = 422 };

/// Enough threads for new connections, because each slow client occupies one.
constexpr std::size_t kThreads = 64;
constexpr time_t kPatience_s = 5;
/// Buckets of a range of a paused stream.
constexpr std::size_t kRowsShown = 1500;
constexpr std::chrono::seconds kLongestBody(10), kLongestUpload(600);

/// Loads only the page's own files; displayed content cannot contain scripts.
constexpr const char* kPagePolicy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; connect-src "
    "'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
/// A report contains its scripts. It gets a separate origin, from which it cannot send requests to this server.
constexpr const char* kReportPolicy =
    "sandbox allow-scripts; default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";

std::string reply_text(const nlohmann::json& document) {
  return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Sends a text piece by piece, because the library compresses a whole one: 0.6 s for a report, to the same computer.
void send_text(Response& response, std::string text, const std::string& type) {
  if (text.empty()) return response.set_content("", type.c_str());
  const auto shared = std::make_shared<const std::string>(std::move(text));
  response.set_content_provider(shared->size(), type.c_str(),
                                [shared](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                  sink.write(shared->data() + offset, length);
                                  return true;
                                });
}

void send(Response& response, const nlohmann::json& document, int status = ok) {
  response.status = status;
  send_text(response, reply_text(document), "application/json");
}

int status_of(ExitCode code) {
  if (code == ExitCode::usage) return bad_request;
  return code == ExitCode::permission ? forbidden : refused;
}

/// Converts exceptions of `work` to answers.
template <typename Work>
void answer(Response& response, Work work) {
  try {
    work();
  } catch (const FaultyLog& faulty) {
    send(response, {{"error", faulty.what()}, {"log", log_faults_json(faulty.faults)}}, refused);
  } catch (const Failure& failure) {
    send(response, {{"error", failure.what()}}, status_of(failure.code));
  } catch (const std::exception& error) {
    send(response, {{"error", error.what()}}, refused);
  }
}

/// Reads the body here, not in the library, to end at the size limit and to limit the time of slow clients.
std::optional<std::string> body_of(const ContentReader& content, Response& response) {
  std::string body;
  const Clock::time_point until = Clock::now() + kLongestBody;
  content([&](const char* data, std::size_t size) {
    body.append(data, size);
    return body.size() <= kLongestRequest && Clock::now() < until;
  });
  if (body.size() <= kLongestRequest && Clock::now() < until) return body;
  send(response, {{"error", fmt::format("a request may have at most {} bytes", kLongestRequest)}}, too_large);
  return std::nullopt;
}

nlohmann::json document_or_null(const Folder& folder, const std::string& name) {
  try {
    return parse_choice(read_file(folder.existing(name)));
  } catch (const Failure&) {
    return nullptr;
  }
}

}  // namespace

struct Server::Parts {
  Folder folder;
  const std::unique_ptr<Live> live;  ///< null without a board
  Jobs jobs;
  std::atomic<std::size_t> streams = 0;
  httplib::Server http;
  int port = 0;
  std::optional<Access> access;
  std::mutex comparing, looking, drawing, designing;
  RecordPictures pictures_of_records{folder};
  std::map<std::string, nlohmann::json> pictures;  ///< pictures of the gallery, by kind
  std::atomic<bool> is_ending = false, has_ended = false;

  using Handled = httplib::Server::HandlerResponse;

  Handled guard(const Query& request, Response& response) const {
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("Referrer-Policy", "no-referrer");
    response.set_header("Cache-Control", "no-store");
    response.set_header("Cross-Origin-Resource-Policy", "same-origin");
    const bool is_opened =
        request.path == "/" && request.has_param("token") && access->is_token(request.get_param_value("token"));
    const bool is_known = is_opened || access->has_cookie(request.get_header_value("Cookie"));
    if (is_known && access->is_own_host(request.get_header_value("Host")) &&
        (request.method == "GET" || access->is_own_origin(request.get_header_value("Origin")))) {
      if (is_opened) response.set_header("Set-Cookie", access->cookie());
      return Handled::Unhandled;
    }
    response.status = forbidden;
    response.set_content("Access denied: open the address that axistool serve printed.\n", "text/plain");
    return Handled::Handled;
  }

  static void send_page(const PageFile& file, Response& response) {
    response.set_header("Content-Security-Policy", kPagePolicy);
    send_text(response, std::string(file.text), std::string(file.type));
  }

  void send_file(const Query& request, Response& response) const {
    const std::string name = folder.existing(request.get_param_value("name"));
    const bool is_report = name.ends_with(".html");
    response.set_header("Content-Security-Policy", kReportPolicy);
    if (!is_report) response.set_header("Content-Disposition", "attachment");
    send_text(response, read_file(name, kLogSize), is_report ? "text/html; charset=utf-8" : "application/octet-stream");
  }

  void send_folder(Response& response) const {
    nlohmann::json files = nlohmann::json::array();
    for (const FolderFile& file : folder.files())
      files.push_back({{"name", file.name}, {"kind", file.kind}, {"bytes", file.bytes}, {"role", file.role}});
    send(response, {{"folder", folder.root().string()},
                    {"files", std::move(files)},
                    {"choice", document_or_null(folder, std::string(kOwnFolder) + "/choice.json")}});
  }

  void take_upload(const Query& request, Response& response, const ContentReader& content) const {
    Upload upload(folder, request.get_param_value("name"));
    const Clock::time_point until = Clock::now() + kLongestUpload;
    const bool whole = content([&](const char* data, std::size_t size) {
      return !is_ending && Clock::now() < until && upload.append(data, size);
    });
    if (whole) return send(response, {{"name", upload.finish()}});
    send(response, {{"error", fmt::format("a file may have at most {} MiB", kLogSize.bytes / kMebibyte)}}, too_large);
  }

  void send_comparison(const Request& request, Response& response) {
    if (request.task != Task::compare) throw Failure(ExitCode::usage, "request, \"do\": expected compare");
    const std::lock_guard one_at_a_time(comparing);
    const CancelledBy scope(&is_ending);
    throw_if_cancelled();
    send_compared(compare(folder, request), command_line(request, {}), response);
  }

  void send_trial(const Request& request, Response& response) {
    const std::lock_guard one_at_a_time(comparing);
    const CancelledBy scope(&is_ending);
    send_compared(compare_trial(folder, request),
                  command_line(request, {fmt::format("{}/{}", kOwnFolder, kTrial), "", ""}), response);
  }

  void send_first_look(const Request& request, Response& response) {
    const std::lock_guard one_at_a_time(looking);
    const CancelledBy scope(&is_ending);
    send(response, look_first(folder, request));
  }

  void send_picture(const std::string& kind, Response& response) {
    const std::lock_guard one_at_a_time(drawing);
    const auto drawn = pictures.find(kind);
    send(response, drawn != pictures.end() ? drawn->second : (pictures[kind] = gallery_picture(kind)));
  }

  static void send_compared(Comparison comparison, const std::string& command, Response& response) {
    send(response, {{"command", command},
                    {"document", std::move(comparison.document)},
                    {"report", std::move(comparison.report)},
                    {"traces", std::move(comparison.traces)},
                    {"text", std::move(comparison.text)}});
  }

  /// Sends the page with all steps from the first model to the requested one.
  void send_story(Request request, Response& response) {
    if (request.task != Task::compare || request.models.size() != 1)
      throw Failure(ExitCode::usage, "request, \"do\": expected compare with one model");
    const std::vector<nlohmann::json> steps = jobs.steps_to(request.models.front());
    if (!steps.empty()) request.models.insert(request.models.begin(), steps.front()["request"]["model"]);
    const std::lock_guard one_at_a_time(comparing);
    const CancelledBy scope(&is_ending);
    send(response, {{"report", story_page(folder, request, steps)}});
  }

  static void send_stops(Response& response) {
    nlohmann::json stops = nlohmann::json::array();
    for (const WaitingProgram& one : waiting_programs())
      stops.push_back({{"id", one.id}, {"program", one.program}, {"line", one.line}});
    send(response, {{"stops", std::move(stops)}});
  }

  void submit(Request request, Response& response) {
    if (!request.like.empty()) throw Failure(ExitCode::usage, "request, \"like\": not for a job");
    if (request.commission) {
      board().require_command(request.commission->owner);
      request.commission->device = board().device();
      request.commission->is_linear =
          read_drive(folder.existing(request.models.front())).data.kind == sim::DriveKind::linear;
    }
    send(response, {{"id", jobs.submit(request)}});
  }

  /// Handles a POST with a JSON body.
  template <typename Work>
  void post(const std::string& path, Work work) {
    http.Post(path, [work](const Query& request, Response& response, const ContentReader& content) {
      const std::optional<std::string> body = body_of(content, response);
      if (body) answer(response, [&] { work(request, response, *body); });
    });
  }

  template <typename Work>
  void get(const std::string& path, Work work) {
    http.Get(path,
             [work](const Query& request, Response& response) { answer(response, [&] { work(request, response); }); });
  }

  void add_page() {
    http.Get("/", [](const Query&, Response& response) { send_page(page_files().front(), response); });
    for (const PageFile& file : page_files())
      http.Get("/page/" + std::string(file.name),
               [&file](const Query&, Response& response) { send_page(file, response); });
  }

  void add_routes() {
    get("/api/folder", [this](const Query&, Response& response) { send_folder(response); });
    get("/api/file", [this](const Query& request, Response& response) { send_file(request, response); });
    get("/api/effects", [](const Query&, Response& response) { send(response, effects_json()); });
    get(R"(/api/effects/([a-z_]{1,60})/picture)",
        [this](const Query& request, Response& response) { send_picture(request.matches[1], response); });
    get("/api/jobs", [this](const Query&, Response& response) { send(response, jobs.list()); });
    get(R"(/api/jobs/(\d{1,6}))", [this](const Query& request, Response& response) {
      const std::optional<nlohmann::json> state = jobs.state(std::stoi(request.matches[1]));
      state ? send(response, *state) : send(response, {{"error", "no such job"}}, not_found);
    });
    post(R"(/api/jobs/(\d{1,6})/cancel)", [this](const Query& request, Response& response, const std::string&) {
      const bool is_there = jobs.cancel(std::stoi(request.matches[1]));
      send(response, nlohmann::json::object(), is_there ? ok : not_found);
    });
    post("/api/jobs",
         [this](const Query&, Response& response, const std::string& body) { submit(parse_request(body), response); });
    get("/api/stops", [](const Query&, Response& response) { send_stops(response); });
    post(R"(/api/stops/([A-Za-z0-9-]{1,40})/continue)",
         [](const Query& request, Response& response, const std::string&) {
           continue_program(request.matches[1]);
           send(response, nlohmann::json::object());
         });
    post("/api/compare", [this](const Query&, Response& response, const std::string& body) {
      send_comparison(parse_request(body), response);
    });
    post("/api/like", [this](const Query&, Response& response, const std::string& body) {
      const Request request = parse_request(body);
      const std::lock_guard one_at_a_time(comparing);
      const CancelledBy scope(&is_ending);
      send(response, {{"document", look_alike(folder, request)}, {"command", command_line(request, {})}});
    });
    post("/api/loop", [this](const Query&, Response& response, const std::string& body) {
      const LoopRequest request = parse_loop(body);
      const std::lock_guard one_at_a_time(designing);
      const CancelledBy scope(&is_ending);
      send(response, design_of(folder, request));
    });
    post("/api/trial", [this](const Query&, Response& response, const std::string& body) {
      send_trial(parse_request(body), response);
    });
    post("/api/look", [this](const Query&, Response& response, const std::string& body) {
      send_first_look(parse_request(body), response);
    });
    post("/api/story", [this](const Query&, Response& response, const std::string& body) {
      send_story(parse_request(body), response);
    });
    post("/api/open", [this](const Query&, Response& response, const std::string& body) {
      send(response, open_and_write(folder, parse_open(body)));
    });
    post("/api/cut", [this](const Query&, Response& response, const std::string& body) {
      const CutRequest request = parse_cut(body);
      send(response, request.keep ? pictures_of_records.keep(request) : cut_out(folder, request));
    });
    post("/api/record", [this](const Query&, Response& response, const std::string& body) {
      send_text(response, pictures_of_records.answer(parse_picture(body)), "application/json");
    });
    post("/api/choice", [this](const Query&, Response& response, const std::string& body) {
      write_file_atomically(folder.own_file("choice.json"), parse_choice(body).dump(2) + "\n");
      send(response, nlohmann::json::object());
    });
    http.Post("/api/files", [this](const Query& request, Response& response, const ContentReader& content) {
      answer(response, [&] { take_upload(request, response, content); });
    });
  }

  Live& board() {
    if (!live) throw Failure(ExitCode::no_such_device, "axistool serve was started without --device");
    return *live;
  }

  /// A POST that commands the board; what `work` returns is sent.
  template <typename Work>
  void command(const std::string& path, Work work) {
    post(path, [this, work](const Query&, Response& response, const std::string& body) {
      send(response, work(board(), body));
    });
  }

  void add_board_routes() {
    using nlohmann::json;
    get("/api/live", [this](const Query&, Response& response) {
      send(response, live ? live->description() : json{{"device", nullptr}});
    });
    get("/api/live/stream",
        [this](const Query& query, Response& response) { stream_live(board(), query, response, streams, is_ending); });
    get("/api/live/parameters", [this](const Query&, Response& response) { send(response, board().parameters()); });
    command("/api/live/rows",
            [](Live& board, const std::string& body) { return board.rows(parse_rows(body), kRowsShown); });
    command("/api/live/claim", [](Live& board, const std::string& body) {
      object_of(body);
      return json{{"owner", board.claim()}, {"number", board.state()["owner"]}};
    });
    command("/api/live/beat", [](Live& board, const std::string& body) {
      board.beat(parse_owner(body));
      return json::object();
    });
    command("/api/live/release", [](Live& board, const std::string& body) {
      board.release(parse_owner(body));
      return json::object();
    });
    command("/api/live/stop", [](Live& board, const std::string&) {
      board.stop();
      return json::object();
    });
    command("/api/live/motion", [](Live& board, const std::string& body) {
      return json{{"command", board.move(parse_motion(body))}};
    });
    command("/api/live/channels", [](Live& board, const std::string& body) {
      board.choose(parse_channels(body));
      return json::object();
    });
    command("/api/live/trigger", [](Live& board, const std::string& body) {
      return json{{"command", board.arm(parse_trigger_wish(body))}};
    });
    command("/api/live/trigger/cancel", [](Live& board, const std::string&) {
      board.disarm();
      return json::object();
    });
    command("/api/live/save", [](Live& board, const std::string& body) {
      return json{{"records", board.save(parse_rows(body))}};
    });
    command("/api/live/parameters", [](Live& board, const std::string& body) {
      return json{{"command", board.set(parse_parameters(body))}};
    });
    command("/api/live/parameters/file", [](Live& board, const std::string& body) {
      return json{{"values", board.staged(parse_parameter_file(body))}};
    });
    command("/api/live/parameters/undo", [](Live& board, const std::string& body) {
      board.undo(parse_owner(body));
      return json::object();
    });
    command("/api/live/parameters/keep", [](Live& board, const std::string& body) {
      board.keep(parse_owner(body));
      return json::object();
    });
  }

  Jobs::Commission commission() {
    if (!live) return {};
    return [this](const Request& request, const Jobs::Tell& tell) { return live->commission(request, tell); };
  }

  Parts(int wanted_port, const LiveDevice& device)
      : live(device.device.empty() ? nullptr : std::make_unique<Live>(folder, device)), jobs(folder, commission()) {
    http.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    // One request for each connection, so that the unread rest of a refused request is not parsed as another.
    http.set_keep_alive_max_count(1);
    http.set_keep_alive_timeout(1);
    http.set_read_timeout(kPatience_s);
    http.set_write_timeout(kPatience_s);
    http.set_payload_max_length(kLogSize.bytes);
    http.set_tcp_nodelay(true);
    // Without SO_REUSEPORT, the library's default, so that no other program can listen on the same port.
    http.set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    http.set_pre_routing_handler([this](const Query& request, Response& response) { return guard(request, response); });
    add_page();
    add_routes();
    add_board_routes();
    const bool is_bound = wanted_port > 0 && http.bind_to_port("127.0.0.1", wanted_port);
    port = is_bound ? wanted_port : wanted_port > 0 ? -1 : http.bind_to_any_port("127.0.0.1");
    if (port <= 0)
      throw Failure(
          ExitCode::permission,
          fmt::format("port {} of 127.0.0.1 is in use or not allowed; give another with --port", wanted_port));
    access.emplace(random_token(), port);
  }
};

Server::Server(int port, const LiveDevice& device) : parts_(std::make_unique<Parts>(port, device)) {}
Server::~Server() = default;

std::string Server::url() const { return parts_->access->url(); }
int Server::port() const { return parts_->port; }

void Server::run() {
  parts_->http.listen_after_bind();
  parts_->has_ended = true;
}

void Server::stop() {
  parts_->is_ending = true;
  // The library's stop() has no effect before the server runs, so it is repeated.
  for (bool is_told = false; !parts_->has_ended; std::this_thread::sleep_for(std::chrono::milliseconds(5))) {
    if (is_told || !parts_->http.is_running()) continue;
    parts_->http.stop();
    is_told = true;
  }
}

}  // namespace host::workbench
