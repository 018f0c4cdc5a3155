// A controller designed on a model and, if there is one, a measured response, before anything is written: figures, and
// how it would move the machine.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/parameters/drive_limits.hpp"
#include "host/report/report.hpp"
#include "host/response/loop_design.hpp"

namespace host {

struct DesignedLoop {
  AxisDesign design;
  ControlFilterChoice filters;
  DriveLimits limits;
  std::optional<LoopDesign> loop;  ///< on the response, if one was given
};

/// The design of `axistool design`. Throws Failure: refused if the drive of the response would oscillate or no
/// bandwidth meets the aim, and what design_axis(), core_filters() and drive_limits() throw.
DesignedLoop designed_loop(const sim::DriveDescription& model, const DesignOptions& options, const LoopAim& aim,
                           LimitWishes limits, const std::optional<AxisResponse>& response);

/// The document of `design --json`.
nlohmann::json designed_loop_json(const DesignedLoop& designed);

/// Adds a step and a move of the model with the designed controller, and, if filters or a response changed it, with
/// that of `options` without filters ("before"): positions, following error, command.
void add_predicted_motion(Report& report, const sim::DriveDescription& model, const DesignedLoop& designed,
                          const DesignOptions& options);

/// Margins and response (response_report) if there is one, limits of the references, and the predicted motion.
Report designed_loop_report(const sim::DriveDescription& model, const DesignedLoop& designed,
                            const DesignOptions& options);

}  // namespace host
