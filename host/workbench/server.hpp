// HTTP server of the workbench: pages and JSON, for this computer only.
#pragma once

#include <memory>
#include <string>

#include "host/workbench/live_device.hpp"

namespace host::workbench {

class Server {
 public:
  /// Serves the working directory on 127.0.0.1; port 0 selects a free port. Accepts connections from now on. Throws
  /// Failure(permission) if the port is not available, and as open_board() if there is a device.
  explicit Server(int port, const LiveDevice& device = {});
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server();

  std::string url() const;  ///< with the token
  int port() const;

  void run();   ///< answers until stop()
  void stop();  ///< stops run() in another thread and waits for its end

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace host::workbench
