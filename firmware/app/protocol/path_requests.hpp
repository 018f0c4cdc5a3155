// Handles the requests for a path of several axes.
#pragma once

#include <span>

#include "firmware/app/board_application.hpp"
#include "firmware/app/protocol/path_messages.hpp"
#include "firmware/app/protocol/report.hpp"

namespace firmware {

template <typename Application>
class PathRequests {
 public:
  explicit PathRequests(Application& app) : app_(app) {}

  Status answer(const Message& request, Message& reply) {
    if (request.type == MessageType::open_path)
      return with<OpenPathRequest>(request, [&](const OpenPathRequest& r) {
        OpenPathPayload opened;
        const Status status = app_.open_path(r, request.asker(), opened);
        if (status == Status::ok) reply.put(opened);
        return status;
      });
    if (request.type == MessageType::probe_state) {
      reply.put(app_.probe().state(probe_contact(app_.active())));
      return Status::ok;
    }
    Status status = Status::ok;
    if (request.type == MessageType::stop_path)
      app_.path().stop();
    else if (request.type != MessageType::path_state)
      status = change(request);
    reply.put(app_.path().state());
    return status;
  }

 private:
  Status change(const Message& request) {
    switch (request.type) {
      case MessageType::path_nodes:
        return app_.path().push(std::span(request.payload).first(request.length));
      case MessageType::start_path:
        return app_.path().start();
      default:
        return with<PathRateRequest>(request, [&](const PathRateRequest& r) { return app_.path().set_rate(r); });
    }
  }

  Application& app_;
};

}  // namespace firmware
