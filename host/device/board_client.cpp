#include "host/device/board_client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <random>

#include "firmware/app/parameters/set_crc.hpp"
#include "host/device/capture_wish.hpp"
#include "host/device/reply_status.hpp"
#include "host/exit_codes.hpp"
#include "host/link/device_users.hpp"

namespace host {

namespace {

using firmware::Message;
using firmware::MessageType;
using firmware::Status;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// Two erases of the largest sector (STM32F405 datasheet, table 40: 2 s each at most), and some more.
constexpr milliseconds kSavePatience{5000};

[[noreturn]] void fail(ExitCode code, const std::string& text) { throw Failure(code, text); }

std::random_device& randomness() {
  thread_local std::random_device device;
  return device;
}

template <typename Payload>
Payload payload_of(const Message& reply) {
  Payload payload;
  if (!reply.get(payload)) fail(ExitCode::protocol, "the board's answer has the wrong length");
  return payload;
}

}  // namespace

BoardClient::BoardClient(std::unique_ptr<ReportLink> link, milliseconds patience)
    : link_(std::move(link)),
      patience_(patience),
      client_(static_cast<std::uint16_t>(std::uniform_int_distribution<unsigned>(1, 0xFFFF)(randomness()))),
      pass_(static_cast<std::uint8_t>(std::uniform_int_distribution<unsigned>(1, 0xFF)(randomness()))) {}

template <typename Payload>
Message BoardClient::request(MessageType type, const Payload& payload) {
  Message message;
  message.type = type;
  message.put(payload);
  return exchange(message, patience_);
}

Message BoardClient::request(MessageType type) {
  Message message;
  message.type = type;
  return exchange(message, patience_);
}

Message BoardClient::exchange(Message message, milliseconds patience) {
  const Message reply = reply_to(message, patience);
  require_accepted(reply);
  return reply;
}

void BoardClient::require_accepted(const Message& reply) const {
  require_ok(reply, reply.status == Status::others_motion ? other_users() : "");
}

Message BoardClient::reply_to(Message message, milliseconds patience) {
  message.sequence = ++sequence_;
  message.client = client_;
  message.set_pass(pass_);
  link_->send(firmware::encode(message));
  const auto deadline = link_->now() + patience;
  while (const auto reply = receive(deadline)) {
    if (reply->type != MessageType::rejected && reply->client != client_) continue;  // for another program
    if (reply->type == MessageType::samples) {
      keep_samples(*reply);
    } else if (reply->type == MessageType::rejected) {
      require_ok(*reply);
      fail(ExitCode::protocol, "the board rejects a report without a reason");
    } else if (reply->type == firmware::reply_to(message.type) && reply->sequence == message.sequence) {
      return *reply;
    }  // otherwise a late answer to a request that has timed out
  }
  const std::string others = other_users();
  fail(ExitCode::time_out,
       fmt::format("{} does not answer within {} ms{}", link_->name(), patience.count(),
                   others.empty() ? ": unplug it and plug it in again; `axistool doctor` looks further" : others));
}

std::optional<Message> BoardClient::receive(steady_clock::time_point deadline) {
  const auto left = std::chrono::ceil<milliseconds>(deadline - link_->now());
  if (left.count() < 0) return std::nullopt;
  const auto report = link_->receive(left);
  if (!report) return std::nullopt;
  Message message;
  const Status envelope = firmware::decode(*report, message);
  if (envelope == Status::ok) return message;
  if (envelope == Status::wrong_version)
    fail(ExitCode::protocol, fmt::format("the board speaks version {} of the protocol, this axistool version {}",
                                         static_cast<unsigned>((*report)[0]), firmware::kProtocolVersion));
  fail(ExitCode::protocol, "a report arrived damaged (checksum): try again, then another cable or port");
}

std::string BoardClient::other_users() const { return host::other_users(link_->file()); }

void BoardClient::keep_samples(const Message& message) {
  constexpr std::size_t kMostWaiting = 100'000;  // more than a minute of samples that the program has not read
  if (message.length <= 4 || message.length % 4 != 0) fail(ExitCode::protocol, "samples of an impossible length");
  if (samples_.size() == kMostWaiting) fail(ExitCode::protocol, "the board sends samples that were not asked for");
  Samples samples;
  std::memcpy(&samples.first_row, message.payload.data(), 4);
  samples.words.resize(message.length / 4 - 1u);
  std::memcpy(samples.words.data(), message.payload.data() + 4, samples.words.size() * 4);
  samples_.push_back(std::move(samples));
}

firmware::IdentityPayload BoardClient::identify() {
  return payload_of<firmware::IdentityPayload>(request(MessageType::identify));
}

BoardState BoardClient::status() {
  BoardState state;
  do {
    const firmware::StatusRequest from{static_cast<std::uint8_t>(state.axis.size())};
    const Message reply = request(MessageType::status, from);
    firmware::StatusPayload part;
    const std::size_t of_axes = reply.length - std::min<std::size_t>(reply.length, sizeof part.board);
    const std::size_t axes = of_axes / sizeof part.axis[0];
    if (axes == 0 || of_axes % sizeof part.axis[0] != 0)
      fail(ExitCode::protocol, "the board's answer has the wrong length");
    std::memcpy(&part, reply.payload.data(), reply.length);
    if (part.board.axis_count == 0 || part.board.axis_count > hal::kMostAxes ||
        (!state.axis.empty() && part.board.axis_count != state.axis_count))
      fail(ExitCode::protocol, fmt::format("the board reports {} axes", part.board.axis_count));
    static_cast<firmware::BoardStatus&>(state) = part.board;
    state.axis.insert(state.axis.end(), part.axis.begin(), part.axis.begin() + static_cast<std::ptrdiff_t>(axes));
  } while (state.axis.size() < state.axis_count);
  state.axis.resize(state.axis_count);
  return state;
}

std::size_t BoardClient::axis_count() {
  if (axis_count_ != 0) return axis_count_;
  const std::size_t axes = identify().axis_count;
  if (axes == 0 || axes > hal::kMostAxes)
    fail(ExitCode::protocol, fmt::format("the board reports {} axes, but 1 to {} are possible", axes, hal::kMostAxes));
  return axis_count_ = axes;
}

firmware::TimingPayload BoardClient::timing(bool begin_anew) {
  const firmware::TimingRequest anew{static_cast<std::uint8_t>(begin_anew ? 1 : 0)};
  const Message reply = request(MessageType::timing, anew);
  firmware::TimingPayload timing;  // older boards send it without the cycles
  std::memcpy(&timing, reply.payload.data(), std::min<std::size_t>(reply.length, sizeof timing));
  return timing;
}

void BoardClient::require_same_table() {
  const firmware::IdentityPayload identity = identify();
  if (identity.schema_hash == firmware::kSchemaHash &&
      identity.parameter_count == firmware::parameter_count(axis_count()))
    return;
  fail(ExitCode::protocol,
       fmt::format("the board's table of parameters ({:#010x}, {} values) is not this program's ({:#010x}, {} values): "
                   "use the axistool that was built with its firmware, or flash the firmware of this one",
                   identity.schema_hash, identity.parameter_count, firmware::kSchemaHash,
                   firmware::parameter_count(axis_count())));
}

firmware::ParameterValues BoardClient::read_values(firmware::ValueSet set) {
  firmware::ParameterValues values(axis_count());
  std::size_t place = 0;
  while (place < values.size()) {
    const firmware::ReadRequest wanted{static_cast<std::uint16_t>(place), set, 0};
    const auto part = payload_of<firmware::ValuesPayload>(request(MessageType::read_values, wanted));
    if (part.first != place || part.count == 0 || part.count > firmware::kValuesPerReport)
      fail(ExitCode::protocol, "the board's answer holds other parameters than were asked for");
    for (std::size_t i = 0; i < part.count && place < values.size(); ++i, ++place) {
      if (part.key[i] != firmware::key_at(place).code)
        fail(ExitCode::protocol, "the board's parameters are in another order: its firmware is another version");
      values.set(place, std::bit_cast<float>(part.bits[i]));
    }
  }
  return values;
}

void BoardClient::write_values(const firmware::ParameterValues& values, bool everything) {
  const firmware::ParameterValues before = read_values();
  if (values.size() != before.size())
    fail(ExitCode::bad_input,
         fmt::format("parameters of {} axes for a board that has {}", values.axes(), before.axes()));
  request(MessageType::begin_staging, firmware::BeginRequest{firmware::ValueSet::active});
  firmware::ValuesPayload part;
  const auto flush = [&] {
    if (part.count != 0) request(MessageType::stage, part);
    part = {};
  };
  for (std::size_t place = 0; place < values.size(); ++place) {
    const auto bits = std::bit_cast<std::uint32_t>(values.at(place));
    if (!everything && bits == std::bit_cast<std::uint32_t>(before.at(place))) continue;
    part.key[part.count] = firmware::key_at(place).code;
    part.bits[part.count++] = bits;
    if (part.count == firmware::kValuesPerReport) flush();
  }
  flush();
  request(MessageType::commit, firmware::CommitRequest{firmware::set_crc(values)});
  if (!(read_values() == values)) fail(ExitCode::protocol, "the board's parameters read back differently");
}

std::vector<firmware::StoredEntry> BoardClient::read_stored() {
  std::vector<firmware::StoredEntry> entries;
  for (;;) {
    const firmware::ReadRequest wanted{static_cast<std::uint16_t>(entries.size()), {}, 0};
    const auto part = payload_of<firmware::ValuesPayload>(request(MessageType::read_stored, wanted));
    if (part.first != entries.size() || part.count > firmware::kValuesPerReport || entries.size() > 4096)
      fail(ExitCode::protocol, "the board's answer holds other entries than were asked for");
    for (std::size_t i = 0; i < part.count; ++i) entries.push_back({part.key[i], 0, part.bits[i]});
    if (part.count < firmware::kValuesPerReport) return entries;
  }
}

void BoardClient::save() {
  Message message;
  message.type = MessageType::save;
  exchange(message, std::max(patience_, kSavePatience));
}

void BoardClient::enable(std::uint8_t axes) { request(MessageType::enable, firmware::AxesRequest{axes}); }
bool BoardClient::enable_at_rest(std::uint8_t axes) {
  Message message;
  message.type = MessageType::enable;
  message.put(firmware::AxesRequest{axes});
  const Message reply = reply_to(message, patience_);
  if (reply.status == Status::not_standing) return false;
  require_accepted(reply);
  return true;
}
void BoardClient::disable(std::uint8_t axes) { request(MessageType::disable, firmware::AxesRequest{axes}); }
void BoardClient::stop() { request(MessageType::stop); }

void BoardClient::jog(std::uint8_t axis, double velocity) {
  request(MessageType::jog, firmware::JogRequest{axis, {}, static_cast<float>(velocity)});
}

void BoardClient::move(std::uint8_t axis, std::int64_t target_counts) {
  request(MessageType::move, firmware::MoveRequest::to(axis, target_counts));
}

void BoardClient::move_by(std::uint8_t axis, std::int64_t counts) {
  request(MessageType::move, firmware::MoveRequest::by(axis, counts));
}

void BoardClient::home(std::uint8_t axis, bool here) {
  request(MessageType::home, firmware::HomeRequest{axis, static_cast<std::uint8_t>(here ? 1 : 0)});
}

void BoardClient::clear_faults() { request(MessageType::clear_faults); }
void BoardClient::heartbeat() { request(MessageType::heartbeat); }
void BoardClient::take_over() { request(MessageType::take_over); }
void BoardClient::restart() { request(MessageType::restart); }

void BoardClient::load_excitation(const firmware::ExcitationEntriesRequest& part) {
  request(MessageType::load_excitation, part);
}

void BoardClient::start_excitation(const firmware::ExcitationRequest& wanted) {
  request(MessageType::start_excitation, wanted);
}

firmware::ExcitationStatePayload BoardClient::stop_excitation() {
  return payload_of<firmware::ExcitationStatePayload>(request(MessageType::stop_excitation));
}

firmware::ExcitationStatePayload BoardClient::excitation_state() {
  return payload_of<firmware::ExcitationStatePayload>(request(MessageType::excitation_state));
}

firmware::OpenPathPayload BoardClient::open_path(const firmware::OpenPathRequest& wanted) {
  const auto opened = payload_of<firmware::OpenPathPayload>(request(MessageType::open_path, wanted));
  if (opened.node_format != wanted.node_format)
    fail(ExitCode::protocol, fmt::format("the board reads a path's nodes in format {}, this axistool writes format {}: "
                                         "flash the firmware of this axistool",
                                         opened.node_format, wanted.node_format));
  return opened;
}

bool BoardClient::path_nodes(std::span<const std::byte> nodes, firmware::PathStatePayload& state) {
  Message message;
  message.type = MessageType::path_nodes;
  std::ranges::copy(nodes, message.payload.begin());
  message.length = static_cast<std::uint8_t>(nodes.size());
  const Message reply = reply_to(message, patience_);
  if (reply.status != Status::no_room) require_accepted(reply);
  state = payload_of<firmware::PathStatePayload>(reply);
  return reply.status == Status::ok;
}

firmware::PathStatePayload BoardClient::start_path() {
  return payload_of<firmware::PathStatePayload>(request(MessageType::start_path));
}

firmware::PathStatePayload BoardClient::path_rate(const firmware::PathRateRequest& wanted) {
  return payload_of<firmware::PathStatePayload>(request(MessageType::path_rate, wanted));
}

firmware::PathStatePayload BoardClient::stop_path() {
  return payload_of<firmware::PathStatePayload>(request(MessageType::stop_path));
}

firmware::PathStatePayload BoardClient::path_state() {
  return payload_of<firmware::PathStatePayload>(request(MessageType::path_state));
}

firmware::ProbeStatePayload BoardClient::probe_state() {
  return payload_of<firmware::ProbeStatePayload>(request(MessageType::probe_state));
}

void BoardClient::arm_trigger(const firmware::TriggerRequest& wanted) { request(MessageType::arm_trigger, wanted); }

firmware::TriggerStatePayload BoardClient::trigger_state() {
  return payload_of<firmware::TriggerStatePayload>(request(MessageType::trigger_state));
}

firmware::TriggeredPayload BoardClient::read_triggered(std::uint32_t first) {
  return payload_of<firmware::TriggeredPayload>(
      request(MessageType::read_triggered, firmware::ReadTriggeredRequest{first}));
}

void BoardClient::start_capture(const firmware::CaptureRequest& wanted) {
  samples_.clear();
  request(MessageType::start_capture, wanted);
}

void BoardClient::take_capture(const firmware::CaptureRequest& wanted) {
  constexpr milliseconds kUntilGiven{2000}, kPause{20};  // a workbench looks ten times a second
  samples_.clear();
  Message message;
  message.type = MessageType::start_capture;
  message.put(wanted);
  Message reply = reply_to(message, patience_);
  if (reply.status == Status::others_capture) {
    const CaptureWish wish(name());
    const auto until = now() + kUntilGiven;
    while (reply.status == Status::others_capture && now() < until) {
      wait(kPause);
      reply = reply_to(message, patience_);
    }
  }
  require_accepted(reply);
}

firmware::CaptureReply BoardClient::stop_capture() {
  return payload_of<firmware::CaptureReply>(request(MessageType::stop_capture));
}

std::optional<firmware::FaultRowPayload> BoardClient::fault_row(std::uint8_t axis, std::uint16_t row) {
  Message message;
  message.type = MessageType::read_fault_capture;
  message.put(firmware::FaultRowRequest{axis, 0, row});
  const Message reply = reply_to(message, patience_);
  if (reply.status == Status::no_such_row) return std::nullopt;
  require_ok(reply);
  return payload_of<firmware::FaultRowPayload>(reply);
}

std::optional<firmware::SlotPayload> BoardClient::read_slot(std::uint8_t slot) {
  Message message;
  message.type = MessageType::read_slot;
  message.put(firmware::ReadSlotRequest{slot});
  const Message reply = reply_to(message, patience_);
  if (reply.status == Status::unknown_request) return std::nullopt;
  require_ok(reply);
  return payload_of<firmware::SlotPayload>(reply);
}

FaultLog BoardClient::fault_log() {
  FaultLog log;
  for (firmware::FaultLogRequest wanted; wanted.age < firmware::kLoggedFaults; ++wanted.age) {
    Message message;
    message.type = MessageType::read_fault_log;
    message.put(wanted);
    const Message reply = reply_to(message, kSavePatience);  // the board may be erasing a sector of the log
    if (reply.status == Status::unknown_request) break;
    if (reply.status != Status::no_such_row) require_ok(reply);
    const auto told = payload_of<firmware::FaultLogPayload>(reply);
    log.run_h = told.run_s / 3600.0;
    if (reply.status == Status::no_such_row) break;
    if (told.entry.axis >= hal::kMostAxes && told.entry.reset == 0)
      fail(ExitCode::protocol, fmt::format("the board logged a fault of axis number {}", told.entry.axis));
    log.faults.push_back(told.entry);
  }
  return log;
}

std::optional<BoardClient::Samples> BoardClient::next_samples(milliseconds patience) {
  const auto deadline = link_->now() + patience;
  while (samples_.empty()) {
    const auto message = receive(deadline);
    if (!message) return std::nullopt;
    if (message->type == MessageType::samples && message->client == client_) keep_samples(*message);
  }
  Samples samples = std::move(samples_.front());
  samples_.pop_front();
  return samples;
}

}  // namespace host
