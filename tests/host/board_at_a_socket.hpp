// A simulated board with the paper's two axes, in real time, behind a socket of its own.
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "host/device/board_client.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/link/socket_link.hpp"
#include "host/simulated_board/socket_board.hpp"
#include "tests/host/temporary_folder.hpp"

class BoardAtASocket {
 public:
  BoardAtASocket() {
    thread_ = std::thread([this] { host::serve_simulated_device(device_, listener_, stop_); });
  }
  explicit BoardAtASocket(const firmware::ParameterValues& values) : BoardAtASocket() { client().write_values(values); }
  ~BoardAtASocket() {
    stop_ = true;
    thread_.join();
  }
  host::BoardClient client() const { return host::BoardClient(host::connect_to_socket(path_)); }
  std::string device() const { return "socket:" + path_; }

 private:
  TemporaryFolder folder_;
  std::string path_ = folder_.path("board.socket");
  host::SimulatedDevice device_{{{{*host::paper_drive("x")}, {*host::paper_drive("y")}}, {}, 1}};
  host::OwnedDescriptor listener_ = host::listen_at_socket(path_);
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};
