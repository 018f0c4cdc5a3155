// The board's end of the protocol: one reply to each request, and samples in between.
#pragma once

#include <algorithm>
#include <array>
#include <bit>

#include "firmware/app/board_application.hpp"
#include "firmware/app/friction_watch.hpp"
#include "firmware/app/parameters/set_crc.hpp"
#include "firmware/app/process_limit.hpp"
#include "firmware/app/protocol/identity_reply.hpp"
#include "firmware/app/protocol/path_requests.hpp"
#include "firmware/app/protocol/pitch_requests.hpp"
#include "firmware/app/protocol/program_facts.hpp"
#include "firmware/app/protocol/report.hpp"
#include "firmware/app/protocol/request_rules.hpp"
#include "firmware/app/protocol/update_requests.hpp"

namespace firmware {

template <typename Application>
class ProtocolServer {
 public:
  ProtocolServer(Application& application, const ImageHeader& image, const BootFacts& boot)
      : app_(application), image_(image), boot_(boot), update_(application, image) {}

  /// One round of the background: at most one report in and one out. Never waits.
  template <hal::UsbHid Usb>
  void poll(Usb& usb, const ProgramUse& use = {}) {
    use_ = use;
    app_.path().poll();
    if (const std::uint32_t period = app_.control_periods(); period != watched_period_) {
      watched_period_ = period;  // periods that a longer round leaves out do not count
      process_limit_.poll(app_);
      friction_watch_.poll(app_);
    }
    app_.keep_fault_log();
    app_.settings().poll();
    if (update_.trial_has_failed()) app_.board().restart();
    if (!usb.is_configured()) {
      reply_waits_ = false;
      app_.capture().stop();
      capture_claim_.release();
      trigger_claim_.release();
      if (restart_wanted_) restart_when_the_reply_is_gone();
      return;
    }
    hal::HidReport report;
    if (!reply_waits_ && usb.receive(report)) {
      reply_ = answer(report);
      reply_waits_ = true;
    }
    if (reply_waits_) {
      reply_waits_ = !usb.send(reply_);
    } else if (restart_wanted_) {
      restart_when_the_reply_is_gone();
    } else {
      send_samples(usb);
    }
  }

  /// The reply to any 64 bytes.
  hal::HidReport answer(const hal::HidReport& report) {
    ++reports_;
    Message request;
    Message reply;
    const Status envelope = decode(report, request);
    if (envelope != Status::ok) {
      ++rejected_;
      reply.type = MessageType::rejected;
      reply.status = envelope;
      return encode(reply);
    }
    reply.type = reply_to(request.type);
    reply.sequence = request.sequence;
    reply.client = request.client;
    const RequestRule* const rule = rule_of(request.type);
    reply.status = rule != nullptr ? permission(*rule, request) : Status::unknown_request;
    if (reply.status == Status::ok) reply.status = handle(request, reply);
    if (reply.status == Status::ok && rule->commands) app_.become_owner(request.asker());
    capture_claim_.hear(request.asker(), app_.control_periods());
    trigger_claim_.hear(request.asker(), app_.control_periods());
    app_.owner_heard(request.asker());  // last: a reply "at rest" also ends the monitoring of the heartbeat
    return encode(reply);
  }

 private:
  static constexpr std::size_t kAxes = Application::kAxes;

  Status permission(const RequestRule& rule, const Message& request) {
    if (request.length < rule.least || request.length > rule.most) return Status::malformed;
    if (restart_wanted_ && acts(rule)) return Status::restarting;
    if (boot_.lacks_brown_out_reset && rule.commands) return Status::brown_out_off;
    if (update_.is_on_trial() && rule.commands) return Status::on_trial;
    const ClientToken client = request.asker();
    switch (rule.asker) {
      case Asker::anyone:
        break;
      case Asker::commander:
        if (!app_.may_command(client)) return Status::others_motion;
        break;
      case Asker::loader:
        if (!app_.may_command(client) || app_.is_others_excitation(client)) return Status::others_motion;
        break;
      case Asker::path_client:
        if (!app_.may_command(client) || app_.path().is_others(client)) return Status::others_motion;
        break;
      case Asker::capture_client:
        if (app_.capture().is_running() && is_others(capture_claim_, client)) return Status::others_capture;
        break;
      case Asker::trigger_client:
        if (is_others(trigger_claim_, client)) return Status::others_capture;
        break;
    }
    return rule.in_motion || !app_.is_in_motion() ? Status::ok : Status::drive_enabled;
  }

  /// A capture belongs to its client until that client falls silent.
  bool is_others(const ClientClaim& claim, ClientToken client) {
    constexpr std::uint32_t kPatience_s = 2;
    const auto patience = kPatience_s * static_cast<std::uint32_t>(app_.active().template get<"control.rate">());
    return claim.is_others(client, app_.control_periods(), patience);
  }

  Status handle(const Message& request, Message& reply) {
    switch (request.type) {
      case MessageType::identify:
        reply.put(identity_of<Application>(image_));
        return Status::ok;
      case MessageType::status:
        if (request.length == 0) return tell_status({}, request.asker(), reply);
        return with<StatusRequest>(request,
                                   [&](const StatusRequest& r) { return tell_status(r, request.asker(), reply); });
      case MessageType::timing:
        return with<TimingRequest>(request, [&](const TimingRequest& r) { return tell_timing(r, reply); });
      case MessageType::read_values:
        return with<ReadRequest>(request, [&](const ReadRequest& r) { return read_values(r, reply); });
      case MessageType::read_stored:
        return with<ReadRequest>(request, [&](const ReadRequest& r) { return read_stored(r, reply); });
      case MessageType::begin_staging:
        return with<BeginRequest>(request, [&](const BeginRequest& r) { return begin_staging(r); });
      case MessageType::stage:
        return with<ValuesPayload>(request, [&](const ValuesPayload& r) { return stage(r, reply); });
      case MessageType::commit:
        return with<CommitRequest>(request, [&](const CommitRequest& r) { return commit(r, reply); });
      case MessageType::save:
        return app_.save();
      case MessageType::begin_table:
      case MessageType::table_points:
      case MessageType::finish_table:
      case MessageType::read_table:
        return PitchRequests<Application>(app_).answer(request, reply);
      case MessageType::restart:
        return restart();
      case MessageType::heartbeat:
      case MessageType::take_over:
        return Status::ok;
      case MessageType::load_excitation:
      case MessageType::start_excitation:
      case MessageType::stop_excitation:
      case MessageType::excitation_state:
        return handle_excitation(request, reply);
      case MessageType::open_path:
      case MessageType::path_nodes:
      case MessageType::start_path:
      case MessageType::path_rate:
      case MessageType::stop_path:
      case MessageType::path_state:
      case MessageType::probe_state:
        return PathRequests<Application>(app_).answer(request, reply);
      case MessageType::begin_update:
      case MessageType::update_block:
      case MessageType::finish_update:
      case MessageType::confirm_update:
      case MessageType::read_slot:
        return update_.answer(request, reply);
      case MessageType::arm_trigger:
        return with<TriggerRequest>(request, [&](const TriggerRequest& r) { return arm(r, request.asker()); });
      case MessageType::trigger_state:
        reply.put(app_.trigger_state());
        return Status::ok;
      case MessageType::read_triggered:
        return with<ReadTriggeredRequest>(request, [&](const ReadTriggeredRequest& r) {
          TriggeredPayload payload;
          if (!app_.read_triggered(r.first, payload)) return Status::no_such_row;
          reply.put(payload);
          return Status::ok;
        });
      default:
        return handle_motion(request, reply);
    }
  }

  Status handle_excitation(const Message& request, Message& reply) {
    switch (request.type) {
      case MessageType::load_excitation:
        return with<ExcitationEntriesRequest>(request, [&](const ExcitationEntriesRequest& r) {
          return r.axis < kAxes ? app_.load_excitation(r, request.asker()) : Status::malformed;
        });
      case MessageType::start_excitation:
        return with<ExcitationRequest>(request, [&](const ExcitationRequest& r) {
          if (r.axis >= kAxes) return Status::malformed;
          RefusedValuePayload refused;
          const Status status = app_.excite(r, refused);
          if (status == Status::bad_value) reply.put(refused);
          return status;
        });
      case MessageType::stop_excitation:
        app_.stop_excitation();
        [[fallthrough]];
      default:
        reply.put(app_.excitation_state());
        return Status::ok;
    }
  }

  Status handle_motion(const Message& request, Message& reply) {
    switch (request.type) {
      case MessageType::enable:
        return with<AxesRequest>(request, [&](const AxesRequest& r) { return enable(r, reply); });
      case MessageType::disable:
        return with<AxesRequest>(request, [&](const AxesRequest& r) { return disable(r); });
      case MessageType::stop:
        app_.stop();
        return Status::ok;
      case MessageType::jog:
        return with<JogRequest>(request, [&](const JogRequest& r) {
          if (r.axis >= kAxes) return Status::malformed;
          const Status status = app_.jog(r.axis, r.velocity);
          if (status == Status::outside_travel) reply.put(app_.limit_of_travel(r.axis, r.velocity > 0));
          if (status == Status::bad_value) reply.put(limit_reply<"limits.unhomed_velocity">(app_.active(), r.axis));
          return status;
        });
      case MessageType::move:
        return with<MoveRequest>(request, [&](const MoveRequest& r) {
          if (r.axis >= kAxes || r.relative > 1) return Status::malformed;
          const Status status = app_.move(r.axis, r.counts(), r.relative != 0);
          if (status == Status::outside_travel)
            reply.put(
                app_.limit_of_travel(r.axis, r.relative != 0 ? r.counts() > 0 : app_.is_ahead(r.axis, r.counts())));
          return status;
        });
      case MessageType::home:
        return with<HomeRequest>(request, [&](const HomeRequest& r) {
          return r.axis < kAxes && r.here <= 1 ? app_.home(r.axis, r.here != 0) : Status::malformed;
        });
      case MessageType::clear_faults:
        app_.clear_faults();
        return Status::ok;
      case MessageType::start_capture:
        return with<CaptureRequest>(request,
                                    [&](const CaptureRequest& r) { return start_capture(r, request.asker()); });
      case MessageType::stop_capture:
        app_.capture().stop();
        capture_claim_.release();
        reply.put(app_.capture().counts());
        return Status::ok;
      case MessageType::read_fault_capture:
        return with<FaultRowRequest>(request, [&](const FaultRowRequest& r) { return fault_row(r, reply); });
      case MessageType::read_fault_log:
        return with<FaultLogRequest>(request, [&](const FaultLogRequest& r) {
          FaultLogPayload payload;
          const bool is_there = app_.logged_fault(r.age, payload);
          reply.put(payload);
          return is_there ? Status::ok : Status::no_such_row;
        });
      default:
        return Status::unknown_request;
    }
  }

  BoardStatus board_status(ClientToken client) {
    const StoreReport& store = app_.store().report();
    BoardStatus board;
    board.control_periods = app_.control_periods();
    board.store_sequence = store.sequence;
    board.store_erases = store.erases;
    board.not_migrated = store.not_migrated;
    board.store_state = static_cast<std::uint8_t>(store.state);
    board.reset_cause = boot_.reset_cause;
    board.axis_count = kAxes;
    board.resets = boot_.resets;
    unsigned flags = app_.has_unsaved_changes() ? kBoardUnsaved : 0;
    if (app_.board().emergency_stop().is_pressed()) flags |= kBoardStopPressed;
    if (app_.capture().is_running()) flags |= kBoardCapturing;
    if (app_.axes().board().was_left_alone()) flags |= kBoardLeftAlone;
    if (boot_.simulated) flags |= kBoardSimulated;
    if (boot_.lacks_brown_out_reset) flags |= kBoardBrownOutOff;
    if (app_.any_enabled()) flags |= app_.is_owner(client) ? kBoardYours : kBoardOthers;
    board.flags = static_cast<std::uint8_t>(flags);
    return board;
  }

  Status tell_status(const StatusRequest& request, ClientToken client, Message& reply) {
    if (request.first_axis >= kAxes) return Status::malformed;
    StatusPayload payload;
    payload.board = board_status(client);
    const std::size_t axes = std::min(kAxes - request.first_axis, kAxesPerStatus);
    for (std::size_t i = 0; i < axes; ++i) payload.axis[i] = app_.axis_status(request.first_axis + i);
    reply.put(payload);
    reply.length = static_cast<std::uint8_t>(sizeof payload.board + axes * sizeof payload.axis[0]);
    return Status::ok;
  }

  Status tell_timing(const TimingRequest& request, Message& reply) {
    TimingPayload payload = app_.timing();
    payload.reports = reports_;
    payload.rejected_reports = rejected_;
    payload.stack_used = use_.stack_used;
    payload.stack_size = use_.stack_size;
    payload.cycles_average = use_.cycles_average;
    payload.cycles_worst = use_.cycles_worst;
    payload.processor_Hz = use_.processor_Hz;
    payload.friction_taken_back = friction_watch_.taken_back(app_);
    reply.put(payload);
    if (request.begin_anew != 0) app_.begin_timing_anew();
    return Status::ok;
  }

  Status read_values(const ReadRequest& request, Message& reply) {
    if (request.set > ValueSet::initial) return Status::malformed;
    ValuesPayload payload;
    payload.first = request.first;
    for (std::size_t place = request.first; place < app_.active().size() && payload.count < kValuesPerReport; ++place) {
      const float value = request.set == ValueSet::active   ? app_.active().at(place)
                          : request.set == ValueSet::staged ? app_.staged().at(place)
                                                            : rule_at(place).initial;
      payload.key[payload.count] = key_at(place).code;
      payload.bits[payload.count++] = std::bit_cast<std::uint32_t>(value);
    }
    reply.put(payload);
    return Status::ok;
  }

  Status read_stored(const ReadRequest& request, Message& reply) {
    ValuesPayload payload;
    payload.first = request.first;
    for (std::size_t index = request.first; payload.count < kValuesPerReport; ++index) {
      const auto entry = app_.store().entry(index);
      if (!entry) break;
      payload.key[payload.count] = entry->key;
      payload.bits[payload.count++] = entry->value_bits;
    }
    reply.put(payload);
    return Status::ok;
  }

  Status begin_staging(const BeginRequest& request) {
    if (request.from == ValueSet::active)
      app_.staged() = app_.active();
    else if (request.from == ValueSet::initial)
      app_.staged() = ParameterValues{kAxes};
    else
      return Status::malformed;
    return Status::ok;
  }

  Status stage(const ValuesPayload& request, Message& reply) {
    if (request.count > kValuesPerReport) return Status::malformed;
    for (std::size_t i = 0; i < request.count; ++i) {
      const ParameterKey key{request.key[i]};
      const auto place = app_.staged().place_of(key);
      const auto refusal =
          place ? check_value(rule_at(*place), std::bit_cast<float>(request.bits[i])) : ValueRefusal::none;
      if (!place || refusal != ValueRefusal::none) {
        reply.put(RefusedValuePayload{key.code, static_cast<std::uint8_t>(refusal), 0, request.bits[i]});
        return place ? Status::bad_value : Status::unknown_parameter;
      }
    }
    for (std::size_t i = 0; i < request.count; ++i)
      app_.staged().set(*place_of({request.key[i]}), std::bit_cast<float>(request.bits[i]));
    return Status::ok;
  }

  Status commit(const CommitRequest& request, Message& reply) {
    if (set_crc(app_.staged()) != request.crc) return Status::set_differs;
    RefusedValuePayload refused;
    const Status status = app_.commit(refused);
    if (status != Status::ok) reply.put(refused);
    return status;
  }

  Status enable(const AxesRequest& request, Message& reply) {
    if (!names_axes(request)) return Status::malformed;
    std::size_t refused = 0;
    const Status status = app_.enable(request.mask, refused);
    if (status != Status::ok) reply.put(RefusedAxisPayload{static_cast<std::uint8_t>(refused), {}});
    return status;
  }

  Status disable(const AxesRequest& request) {
    if (!names_axes(request)) return Status::malformed;
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      if ((request.mask >> axis & 1) != 0) app_.disable(axis);
    return Status::ok;
  }

  static bool names_axes(const AxesRequest& request) { return request.mask != 0 && request.mask >> kAxes == 0; }

  Status start_capture(const CaptureRequest& request, ClientToken client) {
    bool has_unknown = false;
    for (std::size_t axis = 0; axis < request.channels.size(); ++axis)
      has_unknown = has_unknown || request.channels[axis] >> (axis < kAxes ? channels_of(app_.axes()[axis]) : 0) != 0;
    if (request.words() == 0 || request.words() > kWordsPerReport || has_unknown || request.every == 0)
      return Status::malformed;
    app_.start_capture(request);
    capture_claim_.take(client, app_.control_periods());
    return Status::ok;
  }

  /// A client that ends its armed or read capture releases the memory for others.
  Status arm(const TriggerRequest& request, ClientToken client) {
    const Status status = app_.arm(request);
    if (status != Status::ok) return status;
    if (request.after != 0)
      trigger_claim_.take(client, app_.control_periods());
    else
      trigger_claim_.release();
    return Status::ok;
  }

  Status fault_row(const FaultRowRequest& request, Message& reply) {
    if (request.axis >= kAxes) return Status::malformed;
    FaultRowPayload payload;
    if (!firmware::fault_row(app_.axes()[request.axis], request.row, payload)) return Status::no_such_row;
    reply.put(payload);
    return Status::ok;
  }

  Status restart() {
    if (app_.any_enabled()) return Status::drive_enabled;
    restart_wanted_ = true;
    restart_asked_at_ = app_.control_periods();
    return Status::ok;
  }

  void restart_when_the_reply_is_gone() {
    // 20 ms, so that the reply passes the queue and the wire.
    const std::uint32_t longest_way = static_cast<std::uint32_t>(app_.active().template get<"control.rate">()) / 50;
    if (app_.control_periods() - restart_asked_at_ < longest_way) return;
    restart_wanted_ = false;
    if (!app_.any_enabled()) app_.board().restart();
  }

  template <hal::UsbHid Usb>
  void send_samples(Usb& usb) {
    if (!samples_wait_) {
      SamplesPayload payload;
      const std::size_t rows = app_.capture().fetch(payload, app_.capture().is_running());
      if (rows == 0) return;
      Message message;
      message.type = MessageType::samples;
      message.sequence = samples_sent_++;
      message.client = static_cast<std::uint16_t>(capture_claim_.client());
      message.put(payload);
      message.length = static_cast<std::uint8_t>(sizeof payload.first_row + 4 * rows * app_.capture().words_per_row());
      samples_ = encode(message);
      samples_wait_ = true;
    }
    samples_wait_ = !usb.send(samples_);
  }

  Application& app_;
  const ImageHeader& image_;
  BootFacts boot_;
  UpdateRequests<Application> update_;
  FrictionWatch<Application> friction_watch_;
  ProcessLimit<Application> process_limit_;
  std::uint32_t watched_period_ = 0;
  ProgramUse use_{};
  hal::HidReport reply_{};
  hal::HidReport samples_{};
  bool reply_waits_ = false;
  bool samples_wait_ = false;
  bool restart_wanted_ = false;
  std::uint32_t restart_asked_at_ = 0;
  std::uint16_t samples_sent_ = 0;
  ClientClaim capture_claim_, trigger_claim_;
  std::uint32_t reports_ = 0;
  std::uint32_t rejected_ = 0;
};

}  // namespace firmware
