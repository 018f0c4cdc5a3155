// Boards: parameters, control loops and captures, and a simulated board within this process.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>

#include "host/device/capture.hpp"
#include "host/device/motion.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/open_board.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/python/bindings.hpp"
#include "host/python/listening.hpp"
#include "host/python/sources.hpp"
#include "host/simulated_board/socket_board.hpp"
#include "host/simulated_board/usual_wiring.hpp"

namespace axistool_python {

namespace py = pybind11;

namespace {

/// A simulated board with one axis at a socket, until close().
class SimulatedBoard {
 public:
  SimulatedBoard(const sim::DriveDescription& drive, const std::string& socket)
      : socket_(socket), device_({{host::usual_axis(drive)}, "", 1}), listener_(host::listen_at_socket(socket)) {
    thread_ = quiet_thread([this] {
      try {
        host::serve_simulated_device(device_, listener_, stop_);
      } catch (...) {
        fault_ = std::current_exception();
      }
    });
  }
  SimulatedBoard(const SimulatedBoard&) = delete;
  SimulatedBoard& operator=(const SimulatedBoard&) = delete;
  ~SimulatedBoard() { end(); }

  /// Ends the board. Throws the exception that ended it before, if any.
  void close() {
    end();
    if (fault_) std::rethrow_exception(std::exchange(fault_, {}));
  }

 private:
  void end() {
    if (!thread_.joinable()) return;
    stop_ = true;
    thread_.join();
    host::remove_socket(socket_);
  }

  std::string socket_;
  host::SimulatedDevice device_;
  host::OwnedDescriptor listener_;
  std::atomic<bool> stop_ = false;
  std::exception_ptr fault_;
  std::thread thread_;
};

std::unique_ptr<SimulatedBoard> simulated_board(const py::object& model, const std::string& socket) {
  const auto source = model.is_none() ? std::nullopt : std::optional<ModelSource>(model);
  return result_of(py::none(), "sim", [&](const auto&) {
    return std::make_unique<SimulatedBoard>(source ? source->read_data_sheet() : host::paper_drive("x").value(),
                                            socket);
  });
}

/// The board, and the time-out for its answers, s.
struct Device {
  std::string words;
  double patience_s;

  host::BoardClient open() const { return host::open_board(words, std::chrono::duration<double>(patience_s)); }
};

void set_parameters(const Device& device, const std::string& text, const std::string& axis) {
  listen_while(py::none(), "set-params", [&](const auto&) {
    host::BoardClient board = device.open();
    board.require_same_table();
    firmware::ParameterValues values = board.read_values();
    host::axis_index(axis, values.axes());
    for (const host::Assignment& one : host::parse_parameter_text(text, "the parameters", axis)) host::put(values, one);
    host::require_fitting_set(values);
    board.write_values(values);
  });
}

void enable(const Device& device, const std::string& axis) {
  listen_while(py::none(), "enable", [&](const auto&) {
    host::BoardClient board = device.open();
    host::enable_and_wait(board, static_cast<std::uint8_t>(1u << host::axis_index(axis, board.axis_count())));
  });
}

void disable(const Device& device) {
  listen_while(py::none(), "disable", [&](const auto&) {
    host::BoardClient board = device.open();
    host::disable_and_wait(board, static_cast<std::uint8_t>((1u << board.axis_count()) - 1));
  });
}

/// Settings of a capture with the usual channels at loop rate.
host::CaptureSettings settings_of(const firmware::ParameterValues& values, const std::string& axis, double seconds,
                                  const std::vector<std::string>& jogs) {
  host::CaptureSettings settings;
  settings.axis = host::axis_index(axis, values.axes());
  settings.channels = host::usual_channels(values.axis(settings.axis).get<"tachometer.fitted">());
  for (const std::string& jog : jogs) settings.jogs.push_back(host::parse_jog(jog));
  settings.duration_s = seconds > 0.0 || !jogs.empty() ? seconds : 1.0;
  return settings;
}

host::Record record_of_axis(const Device& device, const std::string& axis, double seconds,
                            const std::vector<std::string>& jogs, const Told& done) {
  host::BoardClient board = device.open();
  board.require_same_table();
  const firmware::ParameterValues values = board.read_values();
  const host::CaptureSettings settings = settings_of(values, axis, seconds, jogs);
  host::require_capturable(values, settings);
  if (!jogs.empty() && !host::are_enabled(board, static_cast<std::uint8_t>(1u << settings.axis)))
    throw host::Failure(host::ExitCode::refused, "axis " + axis + " is not enabled, so that it cannot jog: enable it");
  double length_s = settings.duration_s;
  if (length_s == 0.0)
    for (const host::JogStep& jog : settings.jogs) length_s += jog.duration_s;
  const double rows_wanted = std::max(1.0, length_s * static_cast<double>(values.get<"control.rate">()));
  const host::Capture capture = host::run_capture(board, settings, [&](const host::Capture& so_far) {
    done(std::min(1.0, static_cast<double>(so_far.number.size()) / rows_wanted));
    return true;
  });
  host::require_no_loss(capture, "the record");
  return host::capture_record(capture, settings, axis);
}

py::tuple capture(const Device& device, const std::string& axis, double seconds, const std::vector<std::string>& jogs,
                  const py::object& progress) {
  if (!(seconds >= 0.0 && seconds <= 86400.0))
    throw host::Failure(host::ExitCode::usage, "a capture lasts 0 to 86400 s; 0 is as long as its jogs");
  return to_python(result_of(progress, "capture", [&](const Told& done) {
    return host::columns_of(record_of_axis(device, axis, seconds, jogs, done));
  }));
}

}  // namespace

void bind_boards(py::module_& module) {
  py::class_<Device>(module, "Device").def(py::init([](std::string words, double patience_s) {
    return Device{std::move(words), patience_s};
  }));
  py::class_<SimulatedBoard>(module, "SimulatedBoard")
      .def(py::init(&simulated_board))
      .def("close", &SimulatedBoard::close, py::call_guard<py::gil_scoped_release>());
  module.def("set_parameters", &set_parameters);
  module.def("enable", &enable);
  module.def("disable", &disable);
  module.def("capture", &capture);
}

}  // namespace axistool_python
